// SPDX-License-Identifier: Apache-2.0
// Words of shadow bits in the room of the last frame: without enough nothing is touched, and the
// frame is repeated. Also runs under oclgrind.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <optional>

#include "host/lighting/deferred_lighting.h"
#include "host/stages/shadows/draw_shadows.h"
#include "kernels/shared/evaluate_modes.h"
#include "tests/opencl/shadows/casters.h"

namespace kilolux {
namespace {

constexpr uint kUntouched = 0xabcdef01u;

KernelFeatures shadow_features(bool sampled) {
    KernelFeatures features;
    features.shading = SHADING_LAMBERT;
    features.directional_lights = features.shadows = true;
    features.sampled_shadows = sampled;
    return features;
}

// A frame's inputs of `size` x `size` pixels.
struct Shadowed {
    Shadowed(const Gpu& to, const KernelFeatures& with, uint size) : gpu(to), features(with) {
        ViewShape shape;
        shape.width = shape.height = size;
        view = make_view(shape);
        grid = make_cluster_grid({2, 2, 1, 1.0f, 30.0f}, view.width, view.height);
        gbuffer = upload_gbuffer(gpu, make_synthetic(view, features, slanted_depth(3, 20, size)));
        shadows = {random_casters(gpu), unmoved_view(), origins_of(gpu, features, gbuffer)};
        shadows.rays = 4.0f;
        shadows.seed = 1;
    }

    LightInput lights(uint count) const {
        RandomLightOptions mix;
        mix.count = count;
        mix.range_max = 30;
        return upload_lights(gpu, random_lights(view, mix), {{{0, 0, 1, 0}, {1, 1, 1, 0}}});
    }
    LightingInput with(const LightInput& input) const { return {gbuffer, input, grid, shadows}; }
    std::vector<float> planes_of(const Radiance& radiance) const {
        return download<float>(gpu, radiance.planes, std::size_t{3} * view.stride * view.height);
    }

    Gpu gpu;
    KernelFeatures features;
    View view{};
    ClusterGrid grid{};
    GBuffer gbuffer;
    ShadowInput shadows;
};

// All kernels with words, given a word less than they are.
void expect_untouched(int lanes, int group, bool sampled) {
    const Gpu gpu = test_gpu(lanes);
    Tuning tuning = default_tuning(gpu.info);
    tuning.shade_stage = 0;
    tuning.shade_rows = 2;
    tuning.shadow_group = group;
    const Shadowed from(gpu, shadow_features(sampled), 32);
    StageTimer timer;
    LightLists stages(gpu, tuning, from.features);
    GBuffer gbuffer = from.gbuffer;
    gbuffer.version = 1;  // so that shadows may be kept
    const LitPixels lit = stages.run(from.lights(20), gbuffer, from.grid, timer).at(gbuffer);
    CastShadows cast(gpu, tuning, from.features, {});
    const ShadowWords words = cast.reserve(lit.lights, lit.clusters, timer);
    ASSERT_GT(cast.words(), 100u);
    const std::vector<uint> before(cast.words() - 1, kUntouched);
    const ShadowWords few{words.offsets, static_cast<uint>(before.size()), new_buffer(gpu, before)};
    ShadowSamples samples;
    std::optional<Shade> unshadowed;
    if (sampled) {
        KernelFeatures features = from.features;
        features.shadows = features.sampled_shadows = false;
        unshadowed.emplace(gpu, tuning, features);
        samples = {unshadowed->enqueue(lit, timer).planes, 4.0f, 1};
        DrawShadows draw(gpu, tuning, from.features);
        draw.enqueue(lit, few, samples, timer);
    } else {
        KeepShadows keep(gpu, tuning, from.features, "keep");
        keep.save(lit, {words, cast.words()}, stages.counts(), timer);
        const DeviceArray<uint> kept = keep.enqueue(lit, few, timer);
        for (const uint bits : download(gpu, kept)) EXPECT_EQ(bits, 0u);
    }
    cast.enqueue(from.shadows, lit, {few}, timer, samples);
    EXPECT_EQ(download(gpu, few.words, before.size()), before);
    if (sampled) return;
    Shade shade(gpu, tuning, from.features);
    for (const float value : from.planes_of(shade.enqueue(lit, timer, {few}))) {
        ASSERT_EQ(value, 0.0f);
    }
}

TEST(EveryKernel, ShadowsWithoutRoom) {
    expect_untouched(4, 1, false);
    expect_untouched(4, 0, false);
    expect_untouched(1, 32, false);
    expect_untouched(4, 1, true);
}

class ShadowRoom : public testing::TestWithParam<bool> {};

TEST_P(ShadowRoom, AFrameWithMoreWordsThanEverIsRepeated) {
    const Gpu gpu = test_gpu();
    const Tuning tuning = default_tuning(gpu.info);
    const Shadowed from(gpu, shadow_features(GetParam()), 128);
    DeferredLighting lighting(gpu, tuning, from.features);
    StageTimer timer;
    lighting.light(from.with(from.lights(10)), timer);
    const LightInput many = from.lights(3000);
    int frames = 0;
    std::vector<float> lit;
    do {
        lit = from.planes_of(lighting.enqueue(from.with(many), timer));
        ASSERT_LT(++frames, 6);
    } while (!lighting.fits(timer));
    EXPECT_GT(frames, 1);
    DeferredLighting anew(gpu, tuning, from.features);
    EXPECT_EQ(lit, from.planes_of(anew.light(from.with(many), timer)));
    EXPECT_GT(std::ranges::count_if(lit, [](float value) { return value > 0.0f; }), 1000);
    lighting.enqueue(from.with(from.lights(2950)), timer);
    EXPECT_TRUE(lighting.fits(timer)) << "that room stays";
}

// The device waits for an event that comes only after the frame was enqueued.
TEST_P(ShadowRoom, TheSecondFrameIsEnqueuedWithoutAWait) {
    const Gpu gpu = test_gpu();
    const Shadowed from(gpu, shadow_features(GetParam()), 64);
    DeferredLighting lighting(gpu, default_tuning(gpu.info), from.features);
    StageTimer timer;
    lighting.light(from.with(from.lights(40)), timer);
    const LightInput moved = from.lights(50);
    cl::UserEvent go(gpu.context);
    const std::vector<cl::Event> wait{go};
    gpu.queue.enqueueBarrierWithWaitList(&wait);
    auto frame =
        std::async(std::launch::async, [&] { return lighting.enqueue(from.with(moved), timer); });
    const bool is_enqueued = frame.wait_for(std::chrono::minutes(2)) == std::future_status::ready;
    go.setStatus(CL_COMPLETE);
    const Radiance radiance = frame.get();
    EXPECT_TRUE(is_enqueued) << "it waited for the device";
    EXPECT_TRUE(lighting.fits(timer));
    DeferredLighting anew(gpu, default_tuning(gpu.info), from.features);
    EXPECT_EQ(from.planes_of(radiance), from.planes_of(anew.light(from.with(moved), timer)));
}

INSTANTIATE_TEST_SUITE_P(Kinds, ShadowRoom, testing::Values(false, true),
                         [](const auto& kind) { return kind.param ? "sampled" : "exact"; });

}  // namespace
}  // namespace kilolux
