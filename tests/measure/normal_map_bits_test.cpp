// SPDX-License-Identifier: Apache-2.0
// A normal map of 16 bits keeps slopes that 8 bits round away, in every renderer and the reference.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/measure/reference/decoded_samples.h"
#include "host/measure/reference/ray_cast_reference.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

constexpr double kSlope = 1.0 / 4000.0;
constexpr double kElevation = 0.002;  // of the light above the quad

const Camera kFront = look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.3);

// A white quad in z = 0 whose normals lean by the slope towards +x, where the light is.
Scene leaning_quad(bool deep) {
    Scene scene;
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.tangents.assign(4, {1, 0, 0, 1});
    mesh.texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.material = 0;
    scene.instances.push_back({0, glm::dmat4(1.0)});
    Image& image = scene.images.emplace_back(Image{"map", 2, 2, {}});
    for (int texel = 0; texel < 4; ++texel) {
        for (const double v : {kSlope, 0.0, 1.0, 1.0}) {
            const double share = 0.5 + 0.5 * v;
            if (deep) image.rgba16.push_back(static_cast<std::uint16_t>(65535 * share + 0.5));
            if (!deep) image.rgba.push_back(static_cast<std::uint8_t>(255 * share + 0.5));
        }
    }
    scene.textures.push_back({0, {}});
    scene.materials.emplace_back().normal_texture.texture = 0;
    scene.materials[0].metallic = 0.0f;
    SceneLight sun;
    sun.type = LightType::directional;
    sun.direction = {-std::sqrt(1.0 - kElevation * kElevation), 0.0, -kElevation};
    sun.intensity = glm::vec3(1.0f);
    scene.lights.push_back(sun);
    return scene;
}

// How far light is from that on the exact normal, as a share of it.
double error_of(double radiance) {
    const double cosine = (kSlope + kElevation) / std::sqrt(1.0 + kSlope * kSlope);
    return std::abs(radiance * std::numbers::pi / cosine - 1.0);
}

RenderSettings lambert_settings(RendererKind renderer) {
    RenderSettings settings = small_settings(32, 32, 0);
    settings.renderer = renderer;
    settings.shading = Shading::lambert;
    settings.ambient = 0.0f;
    return settings;
}

class NormalMapBits : public testing::TestWithParam<RendererKind> {};

TEST_P(NormalMapBits, SixteenKeepASlopeThatEightRoundAway) {
    const auto error = [](bool deep) {
        const Scene scene = leaning_quad(deep);
        const Frame frame = Renderer(scene, lambert_settings(GetParam())).render(kFront, 0.0);
        return error_of(frame.radiance.at(3 * (16 * 32 + 16)));
    };
    EXPECT_LT(error(true), 0.02);
    EXPECT_GT(error(false), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Renderers, NormalMapBits,
                         testing::Values(RendererKind::deferred, RendererKind::deferred_all,
                                         RendererKind::forward, RendererKind::forward_plus));

TEST(NormalMapBitsOfRays, TheReferenceReadsThemAll) {
    const auto error = [](bool deep) {
        const Scene scene = leaning_quad(deep);
        const SurfaceSamples samples = RayCaster(scene).cast(kFront, 32, 32);
        const ReferencePicture picture =
            shade_reference(samples, reference_lights(scene.lights, kFront, &scene),
                            {.shading = Shading::lambert, .ambient = 0.0});
        return error_of(picture.radiance.rgb.at(3 * (16 * 32 + 16)));
    };
    EXPECT_LT(error(true), 0.02);
    EXPECT_GT(error(false), 1.0);
}

}  // namespace
}  // namespace kilolux
