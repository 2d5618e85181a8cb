// SPDX-License-Identifier: Apache-2.0
// The tasks of LightLists beside running its stages: kept lists, the lists of a pixel; and checks
// of sizes, of all that lights a G-buffer.
#include "host/lighting/light_lists.h"

#include <gtest/gtest.h>

#include "host/certify/synthetic/host_lists.h"
#include "host/lighting/deferred_lighting.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

const GridRequest kListedRequest{4, 4, 1, 1.0f, 50.0f, 0.0f};
constexpr float kDepth = 9.0f;

// 64 x 16 pixels at one depth, of a picture of 64 x 64 from row 32 on.
struct Band {
    Gpu gpu = test_gpu();
    View view = band_view();
    ClusterGrid grid = make_cluster_grid(kListedRequest, 64, 64);
    GBuffer gbuffer =
        upload_gbuffer(gpu, make_synthetic(view, {}, slanted_depth(kDepth, kDepth, 64)));
    LightInput lights = upload_lights(gpu, some_lights());
    LightLists stage{gpu, default_tuning(gpu.info), {}};
    StageTimer timer;

    static View band_view() {
        View view = make_view(ViewShape{64, 64});
        view.first_row = 32;
        view.height = 16;
        return view;
    }
    std::vector<Light> some_lights() const {
        RandomLightOptions mix;
        mix.count = 300;
        mix.range_max = 4;
        return random_lights(view, mix);
    }
};

template <typename Run>
std::string run_error(const Run& run) {
    try {
        run();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

// `run` lights a G-buffer with lights and must refuse counts that their buffers have no room for.
template <typename Run>
void expect_lights_are_checked(const Band& band, const Run& run) {
    const auto message = [&](const LightInput& input) {
        return run_error([&] { run(input, band.gbuffer); });
    };
    LightInput wrong = band.lights;
    wrong.count = 30000000;
    EXPECT_EQ(message(wrong),
              "lighting: lights: a buffer of 14400 bytes; 30000000 rows take 1440000000");
    wrong = band.lights;
    wrong.node_count = 1;  // a row more
    EXPECT_EQ(message(wrong), "lighting: lights: a buffer of 14400 bytes; 301 rows take 14448");
    wrong = band.lights;
    wrong.directional = {};
    wrong.directional_count = 1;
    EXPECT_EQ(message(wrong), "lighting: directional lights: a buffer of 0 bytes; 1 rows take 32");
    EXPECT_EQ(message(band.lights), "");
}

template <typename Run>
void expect_planes_are_checked(const Band& band, const Run& run) {
    GBuffer wrong = band.gbuffer;
    wrong.bytes = cl::Buffer(band.gpu.context, CL_MEM_READ_WRITE, std::size_t{1000});
    EXPECT_EQ(run_error([&] { run(band.lights, wrong); }),
              "lighting: G-buffer: a buffer of 1000 bytes; planes of 64 x 16 take 12288");
    wrong = band.gbuffer;
    wrong.layout.offset_bytes[PLANE_DEPTH] = 1u << 30;
    EXPECT_EQ(run_error([&] { run(band.lights, wrong); }),
              "lighting: G-buffer: a buffer of 12288 bytes; planes of 64 x 16 take 1073745920");
    wrong = band.gbuffer;
    wrong.view.first_row = 4000000000u;
    EXPECT_EQ(run_error([&] { run(band.lights, wrong); }),
              "lighting: cluster grid: 4 x 4 tiles of 16 x 16 pixels in 6 slices, 96 clusters; it "
              "does not hold a picture of 64 x 4000000016");
    wrong = band.gbuffer;
    wrong.view.stride = 65;
    EXPECT_EQ(run_error([&] { run(band.lights, wrong); }),
              "lighting: G-buffer: width 64, stride 65; a stride is the width rounded up to 16");
}

TEST(LightLists, RefuseBuffersThatAreTooSmall) {
    Band band;
    const auto run = [&](const LightInput& lights, const GBuffer& gbuffer) {
        band.stage.run(lights, gbuffer, band.grid, band.timer);
    };
    expect_planes_are_checked(band, run);
    expect_lights_are_checked(band, run);
}

TEST(CoarseLightLists, RefuseBuffersThatAreTooSmall) {
    Band band;
    CoarseLightLists lists(band.gpu, default_tuning(band.gpu.info), {});
    expect_lights_are_checked(band, [&](const LightInput& lights, const GBuffer& gbuffer) {
        lists.run(lights, gbuffer.view, band.grid, band.timer);
    });
}

TEST(AllLightsLighting, RefusesBuffersThatAreTooSmall) {
    Band band;
    AllLightsLighting lighting(band.gpu, default_tuning(band.gpu.info), {});
    const auto run = [&](const LightInput& lights, const GBuffer& gbuffer) {
        lighting.enqueue({gbuffer, lights, band.grid}, band.timer);
        band.gpu.queue.finish();
    };
    expect_planes_are_checked(band, run);
    expect_lights_are_checked(band, run);
}

// Grids of another picture, and none, for all that takes one.
TEST(LightLists, RefuseGridsThatDoNotHoldThePicture) {
    Band band;
    CoarseLightLists coarse(band.gpu, default_tuning(band.gpu.info), {});
    AllLightsLighting all(band.gpu, default_tuning(band.gpu.info), {});
    ClusterGrid miscounted = band.grid;
    miscounted.cluster_count = 5;
    for (const ClusterGrid& grid :
         {make_cluster_grid(kListedRequest, 64, 16), ClusterGrid{}, miscounted}) {
        for (const std::string& message :
             {run_error([&] { band.stage.run(band.lights, band.gbuffer, grid, band.timer); }),
              run_error([&] { coarse.run(band.lights, band.view, grid, band.timer); }),
              run_error([&] {
                  all.enqueue({band.gbuffer, band.lights, grid}, band.timer);
              })}) {
            EXPECT_EQ(message.find("lighting: cluster grid: "), 0u) << message;
        }
    }
}

TEST(DeferredLighting, RefusesShadowsWithoutCasters) {
    Band band;
    KernelFeatures features;
    features.shadows = true;
    DeferredLighting lists(band.gpu, default_tuning(band.gpu.info), features);
    AllLightsLighting all(band.gpu, default_tuning(band.gpu.info), features);
    const LightingInput input{band.gbuffer, band.lights, band.grid};
    const std::string expected =
        "lighting: shadow nodes: a buffer of 0 bytes; a root and its boxes take 448";
    EXPECT_EQ(run_error([&] { lists.light(input, band.timer); }), expected);
    EXPECT_EQ(run_error([&] { all.enqueue(input, band.timer); }), expected);
}

TEST(LightLists, APixelOfABandHasTheListsOfItsPlaceInThePicture) {
    Band band;
    band.stage.list_everywhere();
    const ListedLights lists = band.stage.run(band.lights, band.gbuffer, band.grid, band.timer);
    const HostLists host = download_lists(band.gpu, {}, lists);
    std::size_t different = 0;
    for (uint x = 0; x < 64; x += 16) {
        const PixelLists found = band.stage.at_pixel(lists, band.view, x, 3, kDepth);
        const uint slice = slice_of_depth(band.grid, kDepth);
        const auto coarse_at = [&](uint row) {
            return host.coarse_of(cluster_index(band.grid, x / 16, row, slice)).size();
        };
        EXPECT_EQ(found.coarse_count, coarse_at(2)) << x;
        different += coarse_at(2) != coarse_at(0) ? 1 : 0;
    }
    EXPECT_GT(different, 0u);
}

TEST(LightLists, AreMadeAnewWhereAllClustersAreAskedForAfterwards) {
    Band band;
    band.gbuffer.version = 1;
    band.lights.version = 1;
    const auto entries = [&] {
        const ListedLights lists = band.stage.run(band.lights, band.gbuffer, band.grid, band.timer);
        return download_lists(band.gpu, {}, lists).coarse.size();
    };
    const std::size_t of_pixels = entries();
    band.stage.list_everywhere();
    EXPECT_GT(entries(), of_pixels);
}

}  // namespace
}  // namespace kilolux
