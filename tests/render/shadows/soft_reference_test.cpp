// SPDX-License-Identifier: Apache-2.0
// Reference pictures of lights with a size have soft shadows: the mean of sampled ones.
#include <gtest/gtest.h>

#include "host/measure/reference/decoded_samples.h"
#include "tests/render/shadows/soft_scenes.h"

namespace kilolux {
namespace {

// Of the sum of the picture.
double difference(const std::vector<float>& picture, const RgbImage& exact) {
    double error = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        error += std::abs(picture[i] - exact.rgb[i]);
        sum += exact.rgb[i];
    }
    return error / sum;
}

TEST(SoftReference, IsTheMeanOfSampledShadows) {
    for (const LightType type : kSizedTypes) {
        const ShadowScenario scenario = board_below(panel(type));
        RenderSettings settings = soft_settings(32, 18, 256);
        settings.gbuffer = GBUFFER_FULL;
        Renderer renderer(scenario.scene, settings);
        const Frame frame = renderer.render(scenario.camera, 0.0);
        ReferenceOptions options = reference_options(renderer, scenario.camera);
        options.shadows = {};
        const LitSurfaces lit = renderer.lit_surfaces();
        const ReferencePicture bright = shade_reference(lit, options);
        options.shadows = std::make_shared<ShadowCaster>(scenario.scene, scenario.camera);
        const ReferencePicture exact = shade_reference(lit, options);
        const auto number = static_cast<int>(type);
        EXPECT_LT(difference(frame.radiance, exact.radiance), 0.005) << number;
        EXPECT_GT(difference(frame.radiance, bright.radiance), 0.02) << number;
    }
}

// The reference's quadrature against one of sixteen times the rays, of the sum of the picture.
TEST(SoftReference, ErrsByLittleOfThePicture) {
    for (const LightType type : {LightType::rectangle, LightType::sphere}) {
        const ShadowScenario scenario = board_below(panel(type));
        const RenderSettings settings = soft_settings(32, 18);
        Renderer renderer(scenario.scene, settings);
        renderer.render(scenario.camera, 0.0);
        ReferenceOptions options = reference_options(renderer, scenario.camera);
        options.area_steps = 96;
        const LitSurfaces lit = renderer.lit_surfaces();
        const RgbImage fine = shade_reference(lit, options).radiance;
        options.area_steps = ReferenceOptions{}.area_steps;
        const RgbImage usual = shade_reference(lit, options).radiance;
        const std::vector<float> picture(usual.rgb.begin(), usual.rgb.end());
        EXPECT_LT(difference(picture, fine), 6e-4) << static_cast<int>(type);
        EXPECT_GT(difference(picture, fine), 1e-6) << "the same rays";
    }
}

}  // namespace
}  // namespace kilolux
