// SPDX-License-Identifier: Apache-2.0
// Lights per pixel against a count in double.
#include "host/stages/lists/count_lights.h"

#include <gtest/gtest.h>

#include "host/certify/synthetic/host_lists.h"
#include "tests/support/slice_search.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

struct Bracket {
    uint low = 0, high = 0;
};

// Lights whose range covers p for certain, and those that may by rounding.
Bracket covering(const std::vector<float4>& bounds, const std::vector<Light>& lights,
                 glm::dvec3 p) {
    Bracket count;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const double ratio = length(p - glm::dvec3{bounds[i].x, bounds[i].y, bounds[i].z}) /
                             lights[i].position_range.w;
        count.low += ratio < 1 - 1e-6 ? 1 : 0;
        count.high += ratio < 1 + 1e-6 ? 1 : 0;
    }
    return count;
}

// The counts of an image, and their inputs.
struct Counted {
    ClusterGrid grid{};
    HostLists lists;
    Planes planes;
    std::vector<Light> lights;
    std::vector<float4> bounds;
    std::vector<uint> evaluated, covering;
};

Counted count_lights(int lanes, std::uint32_t light_count) {
    const Gpu gpu = test_gpu(lanes);
    const View view = make_view(ViewShape{49, 35});
    Counted out;
    out.grid = make_cluster_grid({16, 9, 4, 0.5f, 50.0f, 0.0f}, view.width, view.height);
    RandomLightOptions mix;
    mix.count = light_count;
    out.lights = random_lights(view, mix);
    const GBuffer gbuffer =
        upload_gbuffer(gpu, make_synthetic(view, {}, noise_depth(0.3, 60, 0.2, 8)));
    const Tuning tuning = default_tuning(gpu.info);
    const ListedLights device =
        list_everywhere(gpu, tuning, {}, {gbuffer, upload_lights(gpu, out.lights), out.grid});
    out.lists = download_lists(gpu, {}, device);
    CountLights stage(gpu, tuning, {});
    StageTimer timer;
    const LightCounts counts = stage.enqueue(device.at(gbuffer), timer);
    const std::size_t size = std::size_t{view.stride} * view.height;
    out.evaluated = download<uint>(gpu, counts.evaluated, size);
    out.covering = download<uint>(gpu, counts.covering, size);
    out.bounds = download<float4>(gpu, device.lights.bounds, out.lights.size());
    out.planes = decode(gpu, {}, gbuffer);
    return out;
}

void expect_counts(const Counted& c) {
    const View& view = c.planes.view;
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.stride; ++x) {
            const std::size_t i = std::size_t{y} * view.stride + x;
            if (x >= view.width || length(c.planes.vector(SURFACE_NORMAL, x, y)) == 0) {
                ASSERT_EQ(c.evaluated[i], ~0u);
                ASSERT_EQ(c.covering[i], ~0u);
                continue;
            }
            const ActiveCluster* cluster =
                c.lists.find(fine_tile_of(view, x, y),
                             slice_by_search(fine_grid(c.grid), c.planes.at(SURFACE_DEPTH, x, y)));
            ASSERT_NE(cluster, nullptr);
            ASSERT_EQ(c.evaluated[i], cluster->list_count) << "pixel " << x << ", " << y;
            const Bracket expected =
                covering(c.bounds, c.lights, c.planes.vector(SURFACE_POSITION, x, y));
            ASSERT_GE(c.covering[i], expected.low) << "pixel " << x << ", " << y;
            ASSERT_LE(c.covering[i], expected.high) << "pixel " << x << ", " << y;
        }
    }
}

TEST(CountLights, AgreesWithACountInDouble) {
    for (const std::uint32_t count : {0u, 1u, 800u}) expect_counts(count_lights(0, count));
    for (const int lanes : {1, 16}) expect_counts(count_lights(lanes, 300));
}

}  // namespace
}  // namespace kilolux
