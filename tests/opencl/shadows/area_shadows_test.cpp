// SPDX-License-Identifier: Apache-2.0
// Sampled shadows of lights with a size on a small odd image: all forms of the kernels give the
// same bits. Also runs under oclgrind.
#include <gtest/gtest.h>

#include "host/lighting/visibility.h"
#include "kernels/shared/evaluate_modes.h"
#include "tests/opencl/shadows/casters.h"
#include "tests/support/full.h"

namespace kilolux {
namespace {

// Every second light has a size: all kinds, of one side and of two.
std::vector<LightShape> some_shapes(std::size_t count) {
    std::vector<LightShape> out(count);
    for (std::size_t i = 0; i < count; i += 2) {
        const float kind = static_cast<float>(1 + i / 2 % 4);
        out[i] = {{2.0f, 0.0f, 0.5f, kind == SHAPE_SPHERE || i % 4 == 0 ? kind : -kind},
                  {0.3f, 1.5f, -0.2f, 0.2f}};
    }
    return out;
}

struct AreaFrame {
    std::vector<float> whole, listed, all, variance, all_variance;
};

struct AreaCase {
    uint width = 33;
    int shading = SHADING_PBR;
    uint lights = 6;
};

AreaFrame area_frame(int lanes, int group, const AreaCase& asked = {}) {
    const Gpu gpu = test_gpu(lanes);
    Tuning tuning = default_tuning(gpu.info);
    tuning.shade_stage = 0;
    tuning.shade_rows = 2;
    tuning.shadow_group = group;
    KernelFeatures features;
    features.shading = asked.shading;
    features.directional_lights = features.shadows = features.sampled_shadows = true;
    features.area_lights = true;
    ViewShape shape;
    shape.width = asked.width;
    shape.height = 17;
    const View view = make_view(shape);
    RandomLightOptions mix;
    mix.count = asked.lights;
    mix.range_min = 20;
    mix.range_max = 60;
    const ClusterGrid grid = make_cluster_grid({2, 2, 1, 1.0f, 30.0f}, view.width, view.height);
    const GBuffer gbuffer =
        upload_gbuffer(gpu, make_synthetic(view, features, noise_depth(2.0, 50.0, 0.6, 8)));
    LightInput lights =
        upload_lights(gpu, random_lights(view, mix), {{{0, 0, 1, 0}, {1, 1, 1, 0}}});
    lights.extras.shapes = new_buffer(gpu, some_shapes(mix.count));
    StageTimer timer;
    LightLists stages(gpu, tuning, features);
    const ListedLights lists = stages.run(lights, gbuffer, grid, timer);
    spoil_order(gpu, view, lists.clusters);
    const ShadowInput input{random_casters(gpu), unmoved_view(), origins_of(gpu, features, gbuffer),
                            6.0f, 5};
    Visibility visibility(gpu, tuning, features, {});
    const SeenLights seen = visibility.enqueue(lists, gbuffer, input, timer);
    const std::size_t plane = std::size_t{view.stride} * view.height;
    AreaFrame out;
    out.whole = download<float>(gpu, seen.samples.whole, 3 * plane);
    Shade shade(gpu, tuning, features);
    const SeenInput by_bits{.words = seen.words, .samples = seen.samples};
    out.listed =
        download<float>(gpu, shade.enqueue(lists.at(gbuffer), timer, by_bits).planes, 3 * plane);
    out.variance = download<float>(gpu, shade.variance(), plane);
    ShadeAll all(gpu, tuning, features);
    out.all = download<float>(
        gpu, all.enqueue(gbuffer, lists.lights, timer, input, seen.samples).planes, 3 * plane);
    out.all_variance = download<float>(gpu, all.variance(), plane);
    const auto depth01 = download<float>(gpu, gbuffer.bytes.buffer(), plane);
    for (std::size_t i = 0; i < plane; ++i) {
        if (depth01[i] != 0.0f && i % view.stride < view.width) continue;
        out.variance[i] = out.all_variance[i] = 0.0f;  // background has none
    }
    return out;
}

void expect_forms_agree(int lanes, int group) {
    const AreaFrame frame = area_frame(lanes, group, {.width = 17});
    EXPECT_EQ(frame.listed, frame.all);
    EXPECT_EQ(frame.variance, frame.all_variance);
    EXPECT_NE(frame.listed, frame.whole) << "nothing is hidden";
    EXPECT_GT(*std::ranges::max_element(frame.variance), 0.0f);
}

TEST(EveryKernel, AreaShadows) { expect_forms_agree(4, 1); }
TEST(EveryKernel, AreaShadowsByGroup) { expect_forms_agree(1, 32); }
TEST(EveryKernel, AreaShadowsByBundle) { expect_forms_agree(4, 0); }

TEST(AreaShadows, LanesAndFormsChangeNoBit) {
    const AreaFrame one = area_frame(1, 1);
    for (const int lanes : runs_full() ? std::vector{2, 4, 8, 16} : std::vector{16}) {
        const AreaFrame frame = area_frame(lanes, 1);
        EXPECT_EQ(frame.listed, one.listed) << lanes;
        EXPECT_EQ(frame.variance, one.variance) << lanes;
    }
    for (const int group : {0, 64, 128}) EXPECT_EQ(area_frame(1, group).listed, one.listed);
}

// Of many lights a pixel picks few, so that most are no candidates.
TEST(AreaShadows, OfManyLightsAreThoseOfEveryLight) {
    const AreaFrame frame = area_frame(16, 1, {.lights = 200});
    EXPECT_EQ(frame.listed, frame.all);
    EXPECT_EQ(frame.variance, frame.all_variance);
    EXPECT_NE(frame.listed, frame.whole);
}

TEST(AreaShadows, OfMattSurfacesHaveNoGlossyRays) {
    const AreaFrame frame = area_frame(4, 1, {.shading = SHADING_LAMBERT});
    EXPECT_EQ(frame.listed, frame.all);
    EXPECT_NE(frame.listed, frame.whole);
}

}  // namespace
}  // namespace kilolux
