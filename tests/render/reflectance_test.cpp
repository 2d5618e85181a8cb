// SPDX-License-Identifier: Apache-2.0
// KHR_materials_unlit, KHR_materials_ior and KHR_materials_specular, from the material to the
// pixel.
#include <cmath>

#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

Scene glossy_scene() {
    Scene scene = make_generated_scene("plain");
    for (Material& material : scene.materials) material.roughness = 0.3f;
    return scene;
}

const Layer& named_layer(const Frame& frame, const std::string& name) {
    for (const Layer& l : frame.aovs) {
        if (l.name == name) return l;
    }
    throw std::runtime_error("no named_layer " + name);
}

double worst_relative(const Frame& a, const Frame& b) {
    double worst = 0.0;
    for (std::size_t i = 0; i < a.radiance.size(); ++i) {
        worst = std::max(worst, std::abs(double{a.radiance[i]} - b.radiance[i]) /
                                    (std::abs(b.radiance[i]) + 1e-2));
    }
    return worst;
}

TEST(Unlit, LeavesTheSurfaceAsItIsAmongGlossyOnes) {
    Scene scene = glossy_scene();
    scene.materials.front().unlit = true;
    scene.materials.front().base_color = {0.25f, 0.5f, 1.0f, 1.0f};
    for (const uint layout : {GBUFFER_PACKED, GBUFFER_FULL, GBUFFER_HALF, GBUFFER_OCT_2X4}) {
        RenderSettings settings = small_settings();
        settings.gbuffer = layout;
        settings.want.aovs = {"emissive", "depth"};
        const Frame frame = render_once(scene, settings);
        const Layer& emissive = named_layer(frame, "emissive");
        std::size_t unlit = 0, lit = 0;
        for (std::size_t i = 0; i < named_layer(frame, "depth").values.size(); ++i) {
            if (emissive.values[3 * i + 2] == 0.0f) {
                lit += frame.radiance[3 * i] > 0.0f;
                continue;
            }
            ++unlit;
            for (std::size_t c = 0; c < 3; ++c) {
                ASSERT_EQ(frame.radiance[3 * i + c], emissive.values[3 * i + c])
                    << gbuffer_layout_name(layout) << ", pixel " << i;
            }
            ASSERT_NEAR(frame.radiance[3 * i + 1], 0.5, 0.005);
        }
        EXPECT_GT(unlit, 100u);
        EXPECT_GT(lit, 100u);
    }
}

TEST(Unlit, IsTheSameInForwardShading) {
    Scene scene = glossy_scene();
    scene.materials.front().unlit = true;
    RenderSettings settings = small_settings();
    settings.gbuffer = GBUFFER_FULL;
    const Frame deferred = render_once(scene, settings);
    settings.renderer = RendererKind::forward_plus;
    EXPECT_LT(worst_relative(render_once(scene, settings), deferred), 0.01);
}

TEST(Specular, WithoutItsWeightGlossIsLambert) {
    Scene scene = glossy_scene();
    RenderSettings settings = small_settings();
    settings.shading = Shading::lambert;
    const Frame lambert = render_once(scene, settings);
    settings.shading = Shading::pbr;
    const Frame glossy = render_once(scene, settings);
    for (Material& material : scene.materials) material.specular = 0.0f;
    const Frame dull = render_once(scene, settings);
    EXPECT_LT(worst_relative(dull, lambert), 1e-5);
    EXPECT_GT(worst_relative(glossy, lambert), 0.05);
}

TEST(Specular, AnIndexOfOneReflectsOnlyAtGrazingAngles) {
    Scene scene = glossy_scene();
    const RenderSettings settings = small_settings();
    const Frame usual = render_once(scene, settings);
    for (Material& material : scene.materials) material.ior = 1.5f + 1e-7f;
    const Frame nearly = render_once(scene, settings);
    EXPECT_LT(worst_relative(nearly, usual), 1e-5) << "stored as reflectances, the same to 8 bits";
    for (Material& material : scene.materials) material.ior = 2.4f;
    const Frame diamond = render_once(scene, settings);
    EXPECT_GT(worst_relative(diamond, usual), 0.1);
}

TEST(Specular, LayoutsAndForwardShadingAgree) {
    Scene scene = glossy_scene();
    float tint = 0.1f;
    for (Material& material : scene.materials) {
        material.ior = 1.8f;
        material.specular = 0.6f;
        material.specular_color = {2.0f, tint += 0.2f, 0.5f};
    }
    RenderSettings settings = small_settings();
    settings.gbuffer = GBUFFER_FULL;
    const Frame full = render_once(scene, settings);
    settings.renderer = RendererKind::forward_plus;
    const Frame forward = render_once(scene, settings);
    EXPECT_LT(worst_relative(forward, full), 0.01);
    settings.renderer = RendererKind::deferred;
    for (const uint layout : {GBUFFER_PACKED, GBUFFER_HALF, GBUFFER_OCT_2X4}) {
        settings.gbuffer = layout;
        const Frame other = render_once(scene, settings);
        double sum = 0.0, difference = 0.0;
        for (std::size_t i = 0; i < full.radiance.size(); ++i) {
            sum += full.radiance[i];
            difference += std::abs(full.radiance[i] - other.radiance[i]);
        }
        EXPECT_LT(difference, 0.03 * sum) << gbuffer_layout_name(layout);
    }
}

}  // namespace
}  // namespace kilolux
