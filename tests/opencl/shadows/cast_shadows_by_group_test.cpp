// SPDX-License-Identifier: Apache-2.0
// What only the work-group form of cast_shadows does: it takes several nodes and up to a group's
// triangles at once. Bits, walks, rays and seen rays are those of the form by work-items. Runs
// under oclgrind, by the list of cases in tests/CMakeLists.txt; PoCL would run the form by items.
#include <gtest/gtest.h>

#include <random>

#include "host/stages/shadows/cast_shadows.h"
#include "kernels/shared/evaluate_modes.h"
#include "tests/opencl/shadows/casters.h"

namespace kilolux {
namespace {

struct CastResult {
    std::vector<uint> words;
    ShadowCounts counts{};
};

struct CastCase {
    ShadowCasters casters;
    bool has_masks = false;
    uint levels = 0;  // 0: not known
    uint slices = 1;  // of the one tile's depth
    std::vector<Light> lights{};
};

// The shadows of a picture of one tile by groups of `group` items; 1: by single items.
CastResult cast_in_tile(const Gpu& gpu, int group, const CastCase& asked) {
    Tuning tuning = default_tuning(gpu.info);
    tuning.shadow_group = group;
    KernelFeatures features;
    features.shading = SHADING_LAMBERT;
    features.shadows = true;
    SurfaceFeatures surfaces;
    surfaces.masks = asked.has_masks;
    ViewShape shape;
    shape.width = shape.height = FINE_TILE;
    shape.rotated = false;
    const View view = make_view(shape);
    const ClusterGrid grid =
        make_cluster_grid({1, 1, asked.slices, 1.0f, 30.0f}, FINE_TILE, FINE_TILE);
    const GBuffer gbuffer =
        upload_gbuffer(gpu, make_synthetic(view, features, slanted_depth(9, 16, FINE_TILE)));
    const LightInput lights = upload_lights(gpu, asked.lights);
    StageTimer timer;
    LightLists stages(gpu, tuning, features);
    const ListedLights lists = stages.run(lights, gbuffer, grid, timer);
    ShadowInput input{asked.casters, unmoved_view(), origins_of(gpu, features, gbuffer)};
    input.view.levels = asked.levels;
    CastShadows cast(gpu, tuning, features, surfaces, true);
    const ShadowWords words = cast.reserve(lists.lights, lists.clusters, timer);
    cast.enqueue(input, lists.at(gbuffer), {words}, timer);
    return {download(gpu, words.words, cast.words()), cast.counts()};
}

// Nodes whose children are all the next node, and one of leaves that hide everything.
ShadowCasters deep_casters(const Gpu& gpu, std::size_t levels) {
    std::vector<ShadowNode> nodes(levels, empty_node());
    for (std::size_t i = 0; i < levels; ++i) {
        const bool is_last = i + 1 == levels;
        for (int child = 0; child < SHADOW_WIDTH; ++child)
            set_child(nodes[i], child, is_last ? SHADOW_LEAF : static_cast<uint>(i + 1));
    }
    ShadowCasters out = no_casters(gpu);
    out.nodes = new_buffer(gpu, nodes);
    out.triangles = new_buffer(gpu, std::vector<float>{-90, -40, -5, 90, -40, -5, 0, 90, -5});
    return out;
}

// A work-group pops several nodes at once: their children must not outgrow its stack.
void expect_deep_shadows(int group, uint levels, bool are_known) {
    const Gpu gpu = test_gpu(1);
    const CastCase asked{.casters = deep_casters(gpu, levels),
                         .levels = are_known ? levels : 0,
                         .lights = {point_light({0, 0, -1}, 100)}};
    const CastResult by_group = cast_in_tile(gpu, group, asked);
    EXPECT_GT(by_group.counts.rays, 0u);
    EXPECT_EQ(by_group.counts.seen, 0u);
    for (const uint word : by_group.words) EXPECT_EQ(word, 0u);
    EXPECT_EQ(by_group.counts.rays, cast_in_tile(gpu, 1, asked).counts.rays)
        << "each point has one ray";
}

TEST(EveryKernel, DeepShadowsByGroup) {
    expect_deep_shadows(64, 10, true);
    expect_deep_shadows(64, 10, false);
    expect_deep_shadows(64, SHADOW_LEVELS, true);
    expect_deep_shadows(128, 10, true);
    expect_deep_shadows(128, 10, false);
}

constexpr uint kLeafNodes = 4, kLeavesOfNode = 16;

// A root, two nodes and four with sixteen triangles each. Every second triangle has a mask:
// alpha 0 at one corner and 1 at the others.
ShadowCasters crowded_casters(const Gpu& gpu) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> across(-3.0f, 3.0f), depth(-7.0f, -2.0f),
        size(-1.2f, 1.2f);
    std::vector<ShadowNode> nodes(3 + kLeafNodes, empty_node());
    set_child(nodes[0], 3, 1);
    set_child(nodes[0], 9, 2);
    std::vector<float> triangles;
    std::vector<MaskedCaster> masked;
    for (uint i = 0; i < kLeafNodes; ++i) {
        set_child(nodes[1 + i / 2], static_cast<int>(i % 2), 3 + i);
        for (uint leaf = 0; leaf < kLeavesOfNode; ++leaf) {
            const uint number = i * kLeavesOfNode + leaf;
            const float x = across(random), y = across(random), z = depth(random);
            for (int corner = 0; corner < 3; ++corner) {
                triangles.insert(triangles.end(),
                                 {x + size(random), y + size(random), z + size(random)});
            }
            uint child = SHADOW_LEAF | number;
            if (leaf % 2 == 0) {
                child = SHADOW_LEAF | SHADOW_MASKED | static_cast<uint>(masked.size());
                masked.push_back({{}, {}, {0.0f, 1.0f, 1.0f}, number, 0, 0});
            }
            set_child(nodes[3 + i], static_cast<int>(leaf), child);
        }
    }
    SurfaceMaterial material{};
    material.row.base_color = {1, 1, 1, 1};
    material.row.emissive_cutoff = {0, 0, 0, 0.5f};
    material.textures[USE_BASE_COLOR] = SURFACE_ABSENT;
    ShadowCasters out = no_casters(gpu);
    out.nodes = new_buffer(gpu, nodes);
    out.triangles = new_buffer(gpu, triangles);
    out.masked = new_buffer(gpu, masked);
    out.materials = new_buffer(gpu, std::vector{material});
    return out;
}

// More triangles than a group tests at once, some of them with holes, before several clusters.
TEST(EveryKernel, CrowdedShadowsByGroup) {
    const Gpu gpu = test_gpu(1);
    CastCase asked{.casters = crowded_casters(gpu), .has_masks = true, .slices = 2};
    for (int i = 0; i < 10; ++i) {  // more than the 8 groups of a tile
        asked.lights.push_back(point_light({0.4 * i - 2, 1 - 0.2 * i, -0.1 * i}, 100));
    }
    const CastResult by_item = cast_in_tile(gpu, 1, asked);
    for (const int group : {32, 64}) {
        const CastResult by_group = cast_in_tile(gpu, group, asked);
        EXPECT_EQ(by_group.words, by_item.words) << group;
        const ShadowCounts& c = by_group.counts;
        EXPECT_EQ(c.shafts, by_item.counts.shafts);
        EXPECT_GT(c.shafts, asked.lights.size()) << "of several clusters";
        EXPECT_EQ(c.rays, by_item.counts.rays);
        EXPECT_EQ(c.seen, by_item.counts.seen);
        EXPECT_LT(0u, c.seen);
        EXPECT_LT(c.seen, c.rays);
        EXPECT_LE(c.nodes, (3 + kLeafNodes) * c.shafts) << "each once at most";
        EXPECT_LE(c.triangles, kLeafNodes * kLeavesOfNode * c.shafts) << "each once at most";
        EXPECT_GT(c.triangles, 32 * c.shafts) << "more than a group of 32 sets up at once";
    }
}

}  // namespace
}  // namespace kilolux
