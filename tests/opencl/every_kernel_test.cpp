// SPDX-License-Identifier: Apache-2.0
// Every kernel once on a small odd image: these tests run under oclgrind, and are the least that
// any device must pass.
#include <gtest/gtest.h>

#include "host/certify/synthetic/host_lists.h"
#include "host/stages/lists/count_lights.h"
#include "host/stages/lists/count_pairs.h"
#include "host/stages/picture/bloom.h"
#include "host/stages/picture/tonemap.h"
#include "host/stages/shading/fill_background.h"
#include "host/stages/shading/shade.h"
#include "kernels/shared/evaluate_modes.h"
#include "kernels/shared/tone_curve.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

struct Variant {
    int lanes = 4;
    int group = 1;  // of refine_lights, prefix_sum and bin_pixels
    int cull_group = 1;
    int shade_stage = 0;
    int light_index_bits = 16;
    uint layout = GBUFFER_PACKED;
    int shading = SHADING_PBR;
    std::uint32_t light_count = 70;
    uint width = 33;
};

Tuning tuning_of(const Gpu& gpu, const Variant& v) {
    Tuning tuning = default_tuning(gpu.info);
    tuning.refine_group = tuning.prefix_group = tuning.tile_group = v.group;
    tuning.prefix_per_item = v.group == 1 ? 3 : 1;  // several blocks, and one
    tuning.cull_group = v.cull_group;
    tuning.cull_chunks = 18;  // chunks loaded at a time, and two more
    tuning.shade_stage = v.shade_stage;
    tuning.shade_rows = 2;
    tuning.light_group = 4;
    return tuning;
}

KernelFeatures features_of(const Variant& v) {
    KernelFeatures features;
    features.shading = v.shading;
    features.gbuffer = v.layout;
    features.material = features.metallic = features.occlusion = true;
    features.specular = features.sheen = features.anisotropy = features.unlit = true;
    features.clearcoat = features.coat_normals = true;
    features.spot_lights = features.directional_lights = true;
    features.light_index_bits = v.light_index_bits;
    return features;
}

// Radiance by lists, after a check that it has the bits of radiance by all lights.
Radiance shade_both_ways(const Gpu& gpu, Shade& shade, ShadeAll& shade_all, const GBuffer& gbuffer,
                         const ListedLights& lists) {
    StageTimer timer;
    const std::size_t size = std::size_t{3} * gbuffer.view.stride * gbuffer.view.height;
    const Radiance radiance = shade.enqueue(lists.at(gbuffer), timer);
    const auto listed = download<float>(gpu, radiance.planes, size);
    const auto all =
        download<float>(gpu, shade_all.enqueue(gbuffer, lists.lights, timer).planes, size);
    for (std::size_t i = 0; i < size; ++i) {
        EXPECT_EQ(listed[i], all[i]) << "value " << i << " of planes of " << size / 3;
        if (listed[i] != all[i]) break;
    }
    return radiance;
}

// Shading to a display has the bits of tone mapping, which this runs, too.
void show_both_ways(const Gpu& gpu, const Tuning& tuning, Shade& shade, const LitPixels& lit,
                    const Radiance& radiance) {
    constexpr float kExposure = 0.5f;
    StageTimer timer;
    Tonemap tonemap(gpu, tuning, TONE_CURVE_NEUTRAL);
    const auto mapped = download(gpu, tonemap.enqueue(radiance, kExposure, timer));
    const DisplayTarget to = tonemap.target(radiance.view, kExposure);
    gpu.queue.enqueueFillBuffer(to.pixels.buffer(), cl_uint{0}, 0, mapped.size() * sizeof(uint));
    shade.enqueue(lit, timer, {}, to);
    EXPECT_EQ(download(gpu, to.pixels), mapped);
}

void run_every_kernel(const Variant& v) {
    const Gpu gpu = test_gpu(v.lanes);
    const Tuning tuning = tuning_of(gpu, v);
    const KernelFeatures features = features_of(v);
    ViewShape shape;
    shape.width = v.width;
    shape.height = 17;
    const View view = make_view(shape);
    RandomLightOptions mix;
    mix.count = v.light_count;
    mix.range_max = 30;
    mix.spots = 0.3;
    // Padded, since half positions stray from their pixel by up to 0.03 m here.
    const ClusterGrid grid =
        make_cluster_grid({2, 2, 1, 1.0f, 30.0f, 0.1f}, view.width, view.height);
    const GBuffer gbuffer =
        upload_gbuffer(gpu, make_synthetic(view, features, noise_depth(2.0, 50.0, 0.6, 8)));
    const LightInput lights =
        upload_lights(gpu, random_lights(view, mix), {{{0, 0, 1, 0}, {1, 1, 1, 0}}});
    // Lives as long as the test: oclgrind considers reused buffers uninitialised.
    LightLists stages(gpu, tuning, features);
    stages.list_everywhere();
    StageTimer timer;
    const ListedLights lists = stages.run(lights, gbuffer, grid, timer);
    CullLights oracle(gpu, tuning, features);
    oracle.brute_force(lists.lights, lists.boxes, timer);
    oracle.enqueue(lists.lights, lists.boxes, timer, lists.clusters.occupied);
    Shade shade(gpu, tuning, features);
    ShadeAll shade_all(gpu, tuning, features);
    const Radiance radiance = shade_both_ways(gpu, shade, shade_all, gbuffer, lists);
    show_both_ways(gpu, tuning, shade, lists.at(gbuffer), radiance);
    FillBackground background(gpu, tuning);
    background.set_image(std::vector<float>(6, 0.5f), 2, 1);
    background.enqueue(gbuffer, radiance, timer);
    CountLights count(gpu, tuning, features);
    count.enqueue(lists.at(gbuffer), timer);
    decode(gpu, features, gbuffer);
    const HostLists host = download_lists(gpu, features, lists);
    EXPECT_GT(host.refined.size(), 100u);
    const DeviceArray<std::uint64_t> active(
        new_buffer(gpu, std::vector<std::uint64_t>{host.clusters.size(), 0}));
    // A copy: oclgrind loses track of what is initialised where a kernel copies whole structs.
    ActiveClusters clusters = lists.clusters;
    clusters.clusters = new_buffer(gpu, host.clusters);
    CountPairs count_pairs(gpu, tuning);
    count_pairs.enqueue({oracle.total(), active, active}, clusters, true, timer);
    std::uint64_t pairs = 0;
    for (const ActiveCluster& c : host.clusters) pairs += c.list_count;
    EXPECT_EQ(count_pairs.read().refined_pairs, pairs);
}

TEST(EveryKernel, OneItemAGroup) { run_every_kernel({}); }

TEST(EveryKernel, LargeGroupsAndSeveralBatches) {
    run_every_kernel({1, 64, 4, 16, 32, GBUFFER_FULL, SHADING_LAMBERT, 100, 17});
}

TEST(EveryKernel, LanesAndLargeGroups) {
    run_every_kernel({8, 64, 1, 0, 16, GBUFFER_HALF, SHADING_BLINN_PHONG});
}

// Two halvings, both of odd sizes; pixels past the width are not read.
void run_bloom(int lanes) {
    const Gpu gpu = test_gpu(lanes);
    View view{};
    view.width = 35;
    view.height = 37;
    view.stride = 48;
    std::vector<float> planes(std::size_t{3} * view.stride * view.height, 1.0f);
    GrowingBuffer buffer(gpu, "test");
    buffer.reserve(planes.size() * sizeof(float));
    upload<float>(gpu, buffer.get(), planes);
    Bloom bloom(gpu);
    StageTimer timer;
    const Radiance out = bloom.enqueue({buffer.get(), view}, 0.25f, timer);
    const auto glowing = download<float>(gpu, out.planes, planes.size());
    EXPECT_NEAR(glowing[view.stride + 1], 1.0f, 1e-5f);
}

TEST(EveryKernel, BloomOneLane) { run_bloom(1); }

TEST(EveryKernel, BloomLanes) { run_bloom(8); }

}  // namespace
}  // namespace kilolux
