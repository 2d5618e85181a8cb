// SPDX-License-Identifier: Apache-2.0
// Shadows of a few triangles on a small odd image: all forms of the kernel give the same bits. Also
// runs under oclgrind.
#include "host/stages/shadows/cast_shadows.h"

#include <gtest/gtest.h>

#include <bit>

#include "host/certify/synthetic/host_lists.h"
#include "host/stages/shading/shade.h"
#include "host/stages/shadows/count_seen.h"
#include "kernels/shared/evaluate_modes.h"
#include "kernels/shared/gbuffer.h"
#include "tests/opencl/shadows/casters.h"
#include "tests/support/full.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

struct CastFrame {
    std::vector<uint> words;
    std::vector<float> listed, all;
    std::uint64_t seen = 0, facing = 0;
    ShadowCounts counts{};
};

CastFrame cast_frame(int lanes, int group, std::uint32_t light_count = 70, uint width = 33) {
    const Gpu gpu = test_gpu(lanes);
    Tuning tuning = default_tuning(gpu.info);
    tuning.shade_stage = 0;
    tuning.shade_rows = 2;
    tuning.shadow_group = group;
    KernelFeatures features;
    features.shading = SHADING_LAMBERT;
    features.spot_lights = features.directional_lights = features.shadows = true;
    ViewShape shape;
    shape.width = width;
    shape.height = 17;
    const View view = make_view(shape);
    RandomLightOptions mix;
    mix.count = light_count;
    mix.range_max = 30;
    mix.spots = 0.3;
    const ClusterGrid grid = make_cluster_grid({2, 2, 1, 1.0f, 30.0f}, view.width, view.height);
    const GBuffer gbuffer =
        upload_gbuffer(gpu, make_synthetic(view, features, noise_depth(2.0, 50.0, 0.6, 8)));
    const LightInput lights =
        upload_lights(gpu, random_lights(view, mix), {{{0, 0, 1, 0}, {1, 1, 1, 0}}});
    StageTimer timer;
    LightLists stages(gpu, tuning, features);
    const ListedLights lists = stages.run(lights, gbuffer, grid, timer);
    spoil_order(gpu, view, lists.clusters);
    const ShadowInput input{random_casters(gpu), unmoved_view(),
                            origins_of(gpu, features, gbuffer)};
    CastShadows cast(gpu, tuning, features, {}), counting(gpu, tuning, features, {}, true);
    const ShadowWords words = cast.reserve(lists.lights, lists.clusters, timer);
    cast.enqueue(input, lists.at(gbuffer), {words}, timer);
    const std::size_t size = std::size_t{3} * view.stride * view.height;
    CastFrame out;
    out.words = download(gpu, words.words, cast.words());
    counting.enqueue(input, lists.at(gbuffer), {words}, timer);
    out.counts = counting.counts();
    EXPECT_EQ(download(gpu, words.words, cast.words()), out.words) << "counting changes a bit";
    Shade shade(gpu, tuning, features);
    out.listed =
        download<float>(gpu, shade.enqueue(lists.at(gbuffer), timer, {words}).planes, size);
    ShadeAll shade_all(gpu, tuning, features);
    out.all =
        download<float>(gpu, shade_all.enqueue(gbuffer, lists.lights, timer, input).planes, size);
    CountSeen count(gpu, tuning, features);
    const SeenCounts counts = count.enqueue(lists.at(gbuffer), {words}, timer);
    const auto depth01 = download<float>(gpu, gbuffer.bytes.buffer(), size / 3);
    const auto seen = download<uint>(gpu, counts.seen, size / 3);
    const auto facing = download<uint>(gpu, counts.facing, size / 3);
    for (std::size_t i = 0; i < size / 3; ++i) {
        if (depth01[i] == 0.0f || i % view.stride >= view.width) continue;
        out.seen += seen[i];
        out.facing += facing[i];
    }
    return out;
}

// Of a whole word of lights and a part of one, in whole tiles and parts of some: simulators are
// slow.
void expect_shadows(int lanes, int group) {
    const CastFrame frame = cast_frame(lanes, group, 40, 17);
    EXPECT_EQ(frame.listed, frame.all);
    EXPECT_GT(frame.seen, 0u);
    EXPECT_LT(frame.seen, frame.facing);
    const ShadowCounts& c = frame.counts;
    EXPECT_LT(0u, c.seen);
    EXPECT_LE(c.met_rays, c.rays);
    EXPECT_LE(c.rays - c.seen, c.met_rays) << "what is hidden was tested";
    EXPECT_LE(c.shafts, c.rays);
    EXPECT_LE(c.shafts, c.nodes) << "each begins at the root";
    EXPECT_LE(c.triangles, kTriangles * c.shafts);
    EXPECT_LE(c.rays - c.seen, c.points) << "a ray is hidden by a test";
    if (group == 0) return;  // this form leaves bits of background
    std::uint64_t bits = 0;
    for (const uint word : frame.words) bits += static_cast<uint>(std::popcount(word));
    EXPECT_EQ(c.seen, bits);
}

TEST(EveryKernel, Shadows) { expect_shadows(4, 1); }
TEST(EveryKernel, ShadowsByGroup) { expect_shadows(1, 32); }
TEST(EveryKernel, ShadowsByBundle) { expect_shadows(4, 0); }

TEST(CastShadows, LanesChangeNoBit) {
    const CastFrame one = cast_frame(1, 1);
    for (const int lanes : runs_full() ? std::vector{2, 8, 16} : std::vector{16}) {
        const CastFrame frame = cast_frame(lanes, 1);
        EXPECT_EQ(frame.words, one.words) << lanes;
        EXPECT_EQ(frame.listed, one.listed) << lanes;
        EXPECT_EQ(frame.counts.rays, one.counts.rays) << lanes;
        EXPECT_EQ(frame.counts.seen, one.counts.seen) << lanes;
        EXPECT_EQ(frame.counts.shafts, one.counts.shafts) << lanes;
    }
}

TEST(CastShadows, AWalkForEachBundleSeesTheSameByMoreWalks) {
    const CastFrame shafts = cast_frame(4, 1);
    const CastFrame bundles = cast_frame(4, 0);
    EXPECT_EQ(bundles.listed, shafts.listed);
    EXPECT_EQ(bundles.counts.rays, shafts.counts.rays);
    EXPECT_EQ(bundles.counts.seen, shafts.counts.seen);
    EXPECT_GT(bundles.counts.shafts, shafts.counts.shafts);
    EXPECT_GT(bundles.counts.nodes, shafts.counts.nodes);
}

}  // namespace
}  // namespace kilolux
