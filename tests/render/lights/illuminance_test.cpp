// SPDX-License-Identifier: Apache-2.0
// The illuminance of surfaces: as a layer, and in place of radiance.
#include <algorithm>
#include <cmath>

#include "host/picture/decoded_surfaces.h"
#include "host/scene/lights/light_ranges.h"
#include "tests/support/glass_pictures.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

const Layer& layer_named(const Frame& frame, const std::string& name) {
    return *std::ranges::find(frame.aovs, name, &Layer::name);
}

glm::dvec3 vector_at(const Layer& layer, std::size_t i) {
    return {layer.values[3 * i], layer.values[3 * i + 1], layer.values[3 * i + 2]};
}

// The falloff of KHR_lights_punctual times the cosine.
double received(const SceneLight& light, const glm::dvec3& position, const glm::dvec3& normal) {
    const double intensity = luminance_of(glm::dvec3(light.intensity));
    if (light.type == LightType::directional) {
        return intensity * std::max(0.0, glm::dot(normal, -light.direction));
    }
    const glm::dvec3 v = light.position - position;
    const double d2 = glm::dot(v, v), cosine = glm::dot(normal, v) / std::sqrt(d2);
    const double window = std::max(0.0, 1.0 - std::pow(d2 / std::pow(light.range, 2.0), 2.0));
    double cone = 1.0;
    if (light.type == LightType::spot) {
        const double inner = std::cos(light.inner_cone), outer = std::cos(light.outer_cone);
        const double along = glm::dot(-v / std::sqrt(d2), light.direction);
        cone = std::pow(std::clamp((along - outer) / (inner - outer), 0.0, 1.0), 2.0);
    }
    return intensity * cone * window / d2 * std::max(0.0, cosine);
}

RenderSettings with_illuminance(RenderSettings settings) {
    settings.gbuffer = GBUFFER_FULL;
    settings.want.aovs = {"position", "normal", "illuminance"};
    return settings;
}

TEST(Illuminance, IsWhatSurfacesReceiveWhateverTheyReflect) {
    const Scene scene = grid_with_every_light();
    for (const Shading shading : {Shading::lambert, Shading::pbr}) {
        RenderSettings settings = with_illuminance(small_settings(96, 54, 0));
        settings.shading = shading;
        const Frame frame = render_once(scene, settings);
        const Layer& positions = layer_named(frame, "position");
        const Layer& normals = layer_named(frame, "normal");
        const Layer& found = layer_named(frame, "illuminance");
        std::size_t surfaces = 0;
        for (std::size_t i = 0; i < found.values.size(); ++i) {
            const glm::dvec3 normal = vector_at(normals, i);
            if (normal == glm::dvec3(0.0)) continue;
            ++surfaces;
            double expected = 0.0;
            for (const SceneLight& light : scene.lights) {
                expected += received(light, vector_at(positions, i), normal);
            }
            // Positions in the world are rounded to floats.
            EXPECT_NEAR(found.values[i], expected, 2e-5 * expected + 1e-5) << i;
        }
        EXPECT_GT(surfaces, 1000u);
    }
}

TEST(Illuminance, OfThePictureIsThatOfTheLayer) {
    const Scene scene = grid_with_every_light();
    for (const Shadows shadows : {Shadows::off, Shadows::exact}) {
        RenderSettings settings = with_illuminance(small_settings());
        settings.shadows = shadows;
        const Frame layered = render_once(scene, settings);
        const Layer& layer = layer_named(layered, "illuminance");
        settings.renderer = RendererKind::deferred_all;
        EXPECT_EQ(layer_named(render_once(scene, settings), "illuminance").values, layer.values);
        settings.want = radiance_only();
        settings.shading = Shading::illuminance;
        const Frame picture = render_once(scene, settings);
        settings.renderer = RendererKind::deferred;
        EXPECT_EQ(render_once(scene, settings).radiance, picture.radiance);
        for (std::size_t i = 0; i < layer.values.size(); ++i) {
            EXPECT_NEAR(luminance_of(vector_at({"", {}, picture.radiance}, i)), layer.values[i],
                        1e-6 * layer.values[i])
                << i;
        }
    }
}

TEST(Illuminance, IsThatOfOpaqueSurfaces) {
    const Scene scene = glass_scene();
    RenderSettings settings = with_illuminance(small_settings(96, 64, 0));
    settings.shading = Shading::illuminance;
    const Frame frame = render_once(scene, settings);
    const Layer& layer = layer_named(frame, "illuminance");
    EXPECT_GT(*std::ranges::max_element(layer.values), 0.1f);
    for (std::size_t i = 0; i < layer.values.size(); ++i) {
        EXPECT_NEAR(luminance_of(vector_at({"", {}, frame.radiance}, i)), layer.values[i],
                    1e-6 * layer.values[i])
            << i;
    }
}

TEST(Illuminance, IsRefusedByName) {
    const Scene scene = grid_with_every_light();
    RenderSettings settings = with_illuminance(small_settings());
    settings.shadows = Shadows::sampled;
    expect_refused(scene, settings, "illuminance: a layer has no sampled shadows");
    settings.shadows = Shadows::off;
    settings.tails = Tails::stochastic;
    expect_refused(scene, settings, "illuminance: a layer has no stochastic tails");
    settings.tails = Tails::bounded;
    settings.shading = Shading::illuminance;
    settings.want.view = ViewKind::luminance;
    expect_refused(scene, settings, "--show luminance: not of --shading illuminance");
    settings.want.view = ViewKind::lit;
    settings.renderer = RendererKind::forward;
    expect_refused(scene, settings, "illuminance: of the forward renderers only --shading");
}

}  // namespace
}  // namespace kilolux
