// SPDX-License-Identifier: Apache-2.0
// KHR_materials_transmission and KHR_materials_volume against float64, in every renderer.
#include <cmath>

#include "host/scene/lights/prefiltered_environment.h"
#include "tests/support/glass_pictures.h"

namespace kilolux {
namespace {

TEST(Glass, EveryRendererShowsTheFloat64Reference) {
    const Scene scene = glass_scene();
    expect_reference_in_every_renderer(
        [&](const RenderSettings& settings) { return glass_differences(scene, settings); });
}

TEST(Glass, EveryShadingModelLetsLightThrough) {
    const Scene scene = glass_scene();
    for (const Shading shading : {Shading::lambert, Shading::blinn_phong}) {
        RenderSettings settings = lobe_settings();
        settings.shading = shading;
        EXPECT_LT(quantile(glass_differences(scene, settings), 0.5), 2e-5)
            << static_cast<int>(shading);
    }
}

// Before an even environment a white pane that transmits all of its light reflects what is not
// transmitted: both are the light of the environment, but for what Fresnel takes twice.
TEST(Glass, ReflectsNoDiffuseLightOfAnEnvironmentThatItTransmits) {
    Scene scene;
    add_glass_pane(scene, glass(glm::vec3(1.0f)), 0.0, 0.0);
    RenderSettings settings = small_settings(17, 17, 0);
    settings.ambient = 0.0f;
    const Environment even{16, 8, std::vector<glm::vec3>(128, glm::vec3(0.5f))};
    settings.background = std::make_shared<const Environment>(even);
    settings.reflections = std::make_shared<const PrefilteredEnvironment>(prefiltered(even));
    for (const Shading shading : {Shading::pbr, Shading::lambert}) {
        settings.shading = shading;
        const Frame frame =
            Renderer(scene, settings).render(look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.5), 0.0);
        EXPECT_NEAR(frame.radiance[3 * (8 * 17 + 8)], 0.5f, 0.01f) << static_cast<int>(shading);
    }
}

// The radiance of the pixel in the middle of a pane before a wall that glows white.
glm::dvec3 seen_through(const Material& pane, double turn, double scale = 1.0) {
    Material wall;
    wall.base_color = {0.0f, 0.0f, 0.0f, 1.0f};
    wall.emissive = glm::vec3(1.0f);
    Scene scene;
    add_glass_pane(scene, wall, -1.0, 0.0);
    add_glass_pane(scene, pane, 0.0, turn);
    glm::dmat4& place = scene.instances.back().world_from_object;
    place = glm::scale(place, glm::dvec3(scale));
    RenderSettings settings = small_settings(17, 17, 0);
    settings.gbuffer = GBUFFER_FULL;
    settings.shading = Shading::pbr;
    settings.ambient = 0.0f;
    const Frame frame =
        Renderer(scene, settings).render(look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.5), 0.0);
    const std::size_t middle = 3 * (8 * 17 + 8);
    return {frame.radiance[middle], frame.radiance[middle + 1], frame.radiance[middle + 2]};
}

// The extension's text: (1 - F) * base colour, with Schlick's F of the angle to the eye.
TEST(Glass, LetsThroughWhatFresnelLeaves) {
    for (const double turn : {0.0, 0.6, 1.2, 1.4}) {
        const double fresnel = 0.04 + 0.96 * std::pow(1.0 - std::cos(turn), 5.0);
        const glm::dvec3 seen = seen_through(glass({1.0f, 0.5f, 0.25f}), turn);
        const glm::dvec3 right = (1.0 - fresnel) * glm::dvec3(1.0, 0.5, 0.25);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], right[c], 1e-6) << turn;
    }
}

// The extension's text: colour^(thickness / distance); the thickness scales with the node.
TEST(Glass, TintsByItsThickness) {
    Material pane = glass(glm::vec3(1.0f));
    pane.ior = 1.0f;
    pane.thickness = 0.3f;
    pane.attenuation_color = {0.5f, 0.1f, 0.0f};
    EXPECT_EQ(seen_through(pane, 0.0), glm::dvec3(1.0)) << "without a distance";
    pane.attenuation_distance = 0.2f;
    for (const double scale : {1.0, 0.5}) {
        const glm::dvec3 seen = seen_through(pane, 0.0, scale);
        EXPECT_NEAR(seen.x, std::pow(0.5, 1.5 * scale), 1e-6);
        EXPECT_NEAR(seen.y, std::pow(0.1, 1.5 * scale), 1e-6);
        EXPECT_LT(seen.z, 1e-13) << "black";
    }
}

TEST(Glass, OfMetalOrOfNoTransmissionIsOpaque) {
    Material metal = glass(glm::vec3(0.9f));
    metal.metallic = 1.0f;
    EXPECT_EQ(seen_through(metal, 0.0), glm::dvec3(0.0));
    Material none = glass(glm::vec3(0.9f));
    none.transmission = 0.0f;
    EXPECT_EQ(seen_through(none, 0.0), glm::dvec3(0.0));
}

// Cut out by alphaMode MASK: all of what is behind, or what the glass lets through.
TEST(Glass, OfAMaskIsWholeOrNotThere) {
    Material pane = glass(glm::vec3(0.5f));
    pane.ior = 1.0f;
    pane.alpha_mode = AlphaMode::mask;
    pane.base_color.w = 0.6f;
    EXPECT_EQ(seen_through(pane, 0.0).x, 0.5);
    pane.alpha_cutoff = 0.7f;
    EXPECT_EQ(seen_through(pane, 0.0).x, 1.0);
}

// The wall's radiance overflows; the lamp does not light the pane's front.
TEST(Glass, WhatAlphaCoversIsNotSeenAlsoWhereItIsInfinite) {
    Material wall, pane;
    wall.metallic = pane.metallic = 0.0f;
    pane.alpha_mode = AlphaMode::blend;
    Scene scene;
    add_glass_pane(scene, wall, -1.0, 0.0);
    SceneLight lamp;
    lamp.position = {0.0, 0.0, -0.7};
    lamp.intensity = glm::vec3(3e38f);
    lamp.range = 20.0f;
    scene.lights.push_back(lamp);
    RenderSettings settings = small_settings(17, 17, 0);
    settings.gbuffer = GBUFFER_FULL;
    settings.ambient = 0.0f;
    const auto middle_of = [&] {
        const Camera camera = look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.1);
        return Renderer(scene, settings).render(camera, 0.0).radiance[3 * (8 * 17 + 8)];
    };
    EXPECT_TRUE(std::isinf(middle_of()));
    add_glass_pane(scene, pane, 0.0, 0.0);
    for (const RendererKind renderer : {RendererKind::deferred, RendererKind::forward}) {
        settings.renderer = renderer;
        EXPECT_EQ(middle_of(), 0.0f) << static_cast<int>(renderer);
    }
}

TEST(Glass, ABlackTextureIsTheMaterialWithoutIt) {
    Scene scene = glass_scene();
    const TextureUse black = add_texel(scene, {0, 0, 0, 255});
    for (Material& m : scene.materials) {
        m.alpha_mode = AlphaMode::opaque;
        m.transmission_texture = black;
    }
    for (const uint layout : {uint{GBUFFER_PACKED}, uint{GBUFFER_FULL}}) {
        const RenderSettings settings = lobe_settings(layout);
        Scene plain = scene;
        for (Material& m : plain.materials) m.transmission = 0.0f;
        Renderer without(plain, settings), with(scene, settings);
        EXPECT_FALSE(without.plan().transmission);
        EXPECT_TRUE(with.plan().transmission);
        EXPECT_EQ(with.render(kGlassCamera, 0.0).radiance,
                  without.render(kGlassCamera, 0.0).radiance);
    }
}

// Alpha of a texture and of vertices, by parallel rays.
TEST(Glass, OfATextureAndVerticesAlphaBlends) {
    Scene scene = glass_scene();
    for (const std::size_t pane : {1u, 2u}) {
        Material& m = scene.materials[pane];
        m.transmission = 0.0f;
        m.alpha_mode = AlphaMode::blend;
        m.base_color_texture =
            add_noise(scene, 8, 10 + static_cast<unsigned>(pane), {32, 32, 32}, 0);
        scene.meshes[pane].colors = {
            {1, 1, 1, 1}, {1, 0.5f, 1, 0.2f}, {1, 1, 1, 3}, {1, 1, 1, 0.5f}};
        for (glm::vec4& color : scene.meshes[pane].colors) color = glm::min(color, 1.0f);
    }
    Camera camera = kGlassCamera;
    camera.y_extent = 1.3;
    camera.z_far = 20.0;
    for (const RendererKind renderer : {RendererKind::deferred, RendererKind::forward}) {
        for (camera.orthographic = false;; camera.orthographic = true) {
            RenderSettings settings = lobe_settings();
            settings.renderer = renderer;
            const std::vector<double> found = glass_differences(scene, settings, camera);
            EXPECT_GT(found.size(), 4000u);
            EXPECT_LT(quantile(found, 0.5), 2e-5) << static_cast<int>(renderer);
            EXPECT_LT(quantile(found, 0.98), 1e-3) << static_cast<int>(renderer);
            if (camera.orthographic) break;
        }
    }
}

TEST(Glass, BandsAreTheSameBits) {
    const Scene scene = glass_scene();
    RenderSettings settings = lobe_settings();
    const Frame whole = Renderer(scene, settings).render(kGlassCamera, 0.0);
    settings.band_rows = 32;
    EXPECT_EQ(Renderer(scene, settings).render(kGlassCamera, 0.0).radiance, whole.radiance);
}

// The pixels at which all rays nearby meet as many surfaces.
std::vector<std::size_t> even_pixels(const std::vector<SurfaceSamples>& layers) {
    const auto count_at = [&](int x, int y) {
        return std::ranges::count_if(layers, [&](const SurfaceSamples& layer) {
            return layer.at(x, y).kind != SurfaceKind::background;
        });
    };
    std::vector<std::size_t> out;
    const SurfaceSamples& first = layers.front();
    for (int y = 1; y + 1 < first.height; ++y) {
        for (int x = 1; x + 1 < first.width; ++x) {
            const auto here = count_at(x, y);
            if (count_at(x - 1, y) == here && count_at(x + 1, y) == here &&
                count_at(x, y - 1) == here && count_at(x, y + 1) == here) {
                out.push_back(first.index(x, y));
            }
        }
    }
    return out;
}

// The nearest surface that a ray meets, or the opaque one, and the number of the others.
TEST(Glass, AovsTellOfTheLayerAskedFor) {
    const Scene scene = glass_scene();
    RenderSettings settings = lobe_settings();
    settings.want.aovs = {"depth", "layer-count"};
    const std::vector<SurfaceSamples> layers =
        RayCaster(scene).cast_layers(kGlassCamera, settings.width, settings.height);
    for (const RendererKind renderer : {RendererKind::deferred, RendererKind::forward}) {
        settings.renderer = renderer;
        settings.gbuffer = GBUFFER_PACKED;
        for (const SurfaceLayer layer : {SurfaceLayer::opaque, SurfaceLayer::nearest}) {
            settings.want.layer = layer;
            const Frame frame = Renderer(scene, settings).render(kGlassCamera, 0.0);
            int several = 0;
            for (const std::size_t i : even_pixels(layers)) {
                double depth = 0.0;
                std::uint32_t count = 0;
                for (const SurfaceSamples& samples : layers) {
                    const SurfaceSample& s = samples.pixels[i];
                    if (s.kind == SurfaceKind::background) continue;
                    if (s.blended) ++count;
                    if (!s.blended || layer == SurfaceLayer::nearest) depth = -s.position.z;
                }
                several += count > 1 ? 1 : 0;
                ASSERT_NEAR(frame.aovs[0].values[i], depth, 1e-5 * depth) << i;
                ASSERT_EQ(frame.aovs[1].ids[i], count) << i;
            }
            EXPECT_GT(several, 1000);
        }
    }
}

// Before background, too, where no light is evaluated for an opaque surface.
TEST(Glass, NearestSurfacesBeforeBackgroundHaveNoLights) {
    Scene scene;
    add_glass_pane(scene, glass(glm::vec3(0.5f)), 0.0, 0.0);
    RenderSettings settings = small_settings(16, 16, 10);
    settings.want.aovs = {"depth", "light-count"};
    settings.want.layer = SurfaceLayer::nearest;
    settings.want.view = ViewKind::lights;
    const Frame frame =
        Renderer(scene, settings).render(look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.2), 0.0);
    for (const float depth : frame.aovs[0].values) EXPECT_NEAR(depth, 5.0f, 1e-3f);
    for (const std::uint32_t count : frame.aovs[1].ids) EXPECT_EQ(count, 0u);
}

TEST(Glass, TheProbeListsTheLayersFromNearToFar) {
    Scene scene = glass_scene();
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        scene.materials[i].name = std::string(1, static_cast<char>('a' + i));
    }
    RenderSettings settings = lobe_settings();
    settings.want.probes = true;
    Renderer renderer(scene, settings);
    const Frame frame = renderer.render(kGlassCamera, 0.0);
    EXPECT_EQ(frame.stats.layers, 3u);
    const PixelProbe probe = renderer.probe(48, 48);
    ASSERT_EQ(probe.layers.size(), 3u);
    float before = 0.0f;
    for (const auto& [name, layer] : {std::pair("b", 0u), std::pair("a", 1u), std::pair("c", 2u)}) {
        EXPECT_EQ(probe.layers[layer].material, name);
        const float depth = probe.layers[layer].surface[SURFACE_DEPTH];
        EXPECT_GT(depth, before);
        before = depth;
    }
    EXPECT_GT(probe.surface[SURFACE_DEPTH], before);
    EXPECT_FLOAT_EQ(probe.layers[2].surface[SURFACE_TRANSMISSION], 0.6f);
}

}  // namespace
}  // namespace kilolux
