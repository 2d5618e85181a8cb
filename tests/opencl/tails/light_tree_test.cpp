// SPDX-License-Identifier: Apache-2.0
// Cuts through a tree of lights on a small odd image: their error is within its bound. Also runs
// under oclgrind.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>

#include "host/certify/synthetic/host_lists.h"
#include "host/stages/shading/shade.h"
#include "host/stages/tails/tail_errors.h"
#include "kernels/shared/evaluate_modes.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

constexpr float kNoEnd = 1e18f;  // kUnlimitedRange of host/scene/lights/light_ranges.h [m]

// Lights with a range, then the nodes over those without one.
struct TreeLights {
    std::vector<Light> rows;
    std::vector<TreeNode> nodes;
};

Light light_at(double x, double y, double z, const std::array<double, 3>& intensity) {
    const auto f = [](double v) { return static_cast<float>(v); };
    return {{f(x), f(y), f(z), kNoEnd},
            {f(intensity[0]), f(intensity[1]), f(intensity[2]), 1.0f},
            {0.0f, 0.0f, 0.0f, -1.0f}};
}

double square(const Light& light, const Light& from) {
    const double x = double{light.position_range.x} - from.position_range.x;
    const double y = double{light.position_range.y} - from.position_range.y;
    const double z = double{light.position_range.z} - from.position_range.z;
    return x * x + y * y + z * z;
}

// The node of these lights at their weighted centre, which all colours share: each is grey.
void add_node(TreeLights& out, std::span<const Light> lights) {
    const std::size_t place = out.nodes.size();
    out.nodes.push_back({});
    double sum = 0.0, x = 0.0, y = 0.0, z = 0.0;
    for (const Light& light : lights) {
        const double i = light.color_scale.x;
        sum += i;
        x += i * light.position_range.x;
        y += i * light.position_range.y;
        z += i * light.position_range.z;
    }
    const Light centre = light_at(x / sum, y / sum, z / sum, {sum, sum, sum});
    out.rows.push_back(centre);
    if (lights.size() > 1) {
        add_node(out, lights.first(lights.size() / 2));
        add_node(out, lights.subspan(lights.size() / 2));
        double radius2 = 0.0, second = 0.0;
        for (const Light& light : lights) {
            radius2 = std::max(radius2, square(light, centre));
            second += light.color_scale.x * square(light, centre);
        }
        constexpr double kRoundUp = 1.0 + 1e-4;
        out.nodes[place].radius = static_cast<float>(kRoundUp * std::sqrt(radius2));
        out.nodes[place].spread = static_cast<float>(kRoundUp * std::sqrt(second / sum));
        out.nodes[place].offset =
            1e-4f * out.nodes[place].radius;  // rounding moves it by that much
    }
    out.nodes[place].next = static_cast<uint>(out.nodes.size());
}

// Points in a line that leads away from the view.
TreeLights lights_beside(const View& view) {
    RandomLightOptions mix;
    mix.count = 20;
    mix.range_max = 30;
    TreeLights out{random_lights(view, mix), {}};
    std::vector<Light> points;
    for (int i = 0; i < 24; ++i) {
        const double intensity = 50.0 + 10.0 * (i % 3);
        points.push_back(light_at(-20.0 + 2.0 * i, 15.0 + i % 5, -8.0 - 0.9 * i,
                                  {intensity, intensity, intensity}));
    }
    add_node(out, points);
    return out;
}

struct TreeFrame {
    std::vector<float> radiance, bound;
    std::uint64_t entries = 0;
};

TreeFrame light_by_tree(int lanes, float share) {
    const Gpu gpu = test_gpu(lanes);
    Tuning tuning = default_tuning(gpu.info);
    tuning.shade_stage = 0;
    tuning.shade_rows = 2;
    KernelFeatures features;
    features.shading = SHADING_LAMBERT;
    features.light_tree = true;
    features.tree_share = share;
    ViewShape shape;
    shape.width = 33;
    shape.height = 17;
    const View view = make_view(shape);
    const ClusterGrid grid = make_cluster_grid({2, 2, 1, 1.0f, 30.0f}, view.width, view.height);
    const GBuffer gbuffer =
        upload_gbuffer(gpu, make_synthetic(view, features, noise_depth(2.0, 50.0, 0.6, 8)));
    const TreeLights tree = lights_beside(view);
    LightInput lights = upload_lights(gpu, tree.rows, {});
    lights.node_count = static_cast<uint>(tree.nodes.size());
    lights.count -= lights.node_count;
    lights.nodes = new_buffer(gpu, tree.nodes);
    StageTimer timer;
    LightLists stages(gpu, tuning, features);
    const ListedLights lists = stages.run(lights, gbuffer, grid, timer);
    Shade shade(gpu, tuning, features);
    TailErrors errors(gpu, tuning, features);
    const std::size_t size = std::size_t{3} * view.stride * view.height;
    TreeFrame out;
    out.radiance = download<float>(gpu, shade.enqueue(lists.at(gbuffer), timer).planes, size);
    out.bound = download<float>(gpu, errors.tree_bound(lists.at(gbuffer), timer), size);
    for (const ActiveCluster& c : stages.active_clusters(lists)) out.entries += c.list_count;
    return out;
}

void expect_within_bound(int lanes) {
    const TreeFrame exact = light_by_tree(lanes, 0.0f), grouped = light_by_tree(lanes, 0.3f);
    EXPECT_LT(grouped.entries, exact.entries) << "some lights go together";
    double error = 0.0, bound = 0.0;
    for (std::size_t i = 0; i < exact.radiance.size(); ++i) {
        const double off = std::abs(double{exact.radiance[i]} - grouped.radiance[i]);
        EXPECT_LE(off, grouped.bound[i] + 1e-6 * exact.radiance[i]) << i;
        error += off;
        bound += grouped.bound[i];
    }
    EXPECT_GT(error, 0.0);
    EXPECT_GT(bound, error);
}

TEST(EveryKernel, LightTree) { expect_within_bound(4); }

TEST(LightTreeKernels, LanesChangeNoBit) {
    const TreeFrame one = light_by_tree(1, 0.3f), eight = light_by_tree(8, 0.3f);
    EXPECT_EQ(one.radiance, eight.radiance);
    EXPECT_EQ(one.bound, eight.bound);
}

}  // namespace
}  // namespace kilolux
