// SPDX-License-Identifier: Apache-2.0
// KHR_materials_transmission and KHR_materials_volume against float64, in every renderer.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "host/measure/metrics/metrics.h"
#include "host/measure/reference/decoded_samples.h"
#include "host/measure/reference/ray_cast_reference.h"
#include "host/render/renderer.h"
#include "host/scene/lights/prefiltered_environment.h"
#include "tests/support/render_fixture.h"
#include "tests/support/sphere_scene.h"

namespace kilolux {
namespace {

const Camera kGlassCamera = look_at({0.5, 0.8, 5.0}, {0, 0, 0}, {0, 1, 0}, 0.55);

void add_glass_pane(Scene& scene, const Material& material, double z, double turn) {
    Mesh mesh;
    mesh.positions = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(material);
    scene.meshes.push_back(mesh);
    const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, z));
    const glm::dmat4 place = glm::rotate(moved, turn, glm::dvec3(0, 1, 0));
    scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, place});
}

Material glass(const glm::vec3& color) {
    Material m;
    m.base_color = glm::vec4(color, 1.0f);
    m.metallic = 0.0f;
    m.roughness = 0.3f;
    m.transmission = 1.0f;
    m.double_sided = true;
    return m;
}

// A sphere of green glass with maps, behind a pane that is metal in part and before another one
// with a coat; a wall behind all.
Scene glass_scene() {
    Material ball = glass({0.9f, 0.95f, 1.0f});
    ball.double_sided = false;
    ball.ior = 1.8f;
    ball.thickness = 0.8f;
    ball.attenuation_distance = 0.5f;
    ball.attenuation_color = {0.3f, 0.8f, 0.5f};
    Scene scene = sphere_scene(ball);
    scene.instances[0].world_from_object =
        glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(0.1, 0.0, 0.0)), glm::dvec3(1.2));
    scene.materials[0].transmission_texture = add_noise(scene, 16, 5, {128, 0, 0});
    scene.materials[0].thickness_texture = add_noise(scene, 16, 6, {0, 64, 0});
    Material front = glass({0.9f, 0.6f, 0.4f});
    front.metallic = 0.4f;
    front.sheen_color = {0.2f, 0.2f, 0.3f};
    front.sheen_roughness = 0.5f;
    front.alpha_mode = AlphaMode::blend;
    front.base_color.w = 0.7f;
    add_glass_pane(scene, front, 1.5, 0.4);
    Material back = glass({0.5f, 0.7f, 0.9f});
    back.transmission = 0.6f;
    back.clearcoat = 0.5f;
    back.specular = 0.4f;
    add_glass_pane(scene, back, -1.5, -0.3);
    Material wall;
    wall.metallic = 0.0f;
    wall.roughness = 0.6f;
    wall.double_sided = true;
    add_glass_pane(scene, wall, -2.5, 0.1);
    scene.materials.back().base_color_texture = add_noise(scene, 8, 7, {32, 32, 32});
    for (int i = 0; i < 12; ++i) {
        const double angle = 0.5 * i;
        SceneLight light;
        light.type = i % 3 == 0 ? LightType::spot : LightType::point;
        light.position = {2.5 * std::cos(angle), 0.4 * i - 2.0, 2.7 * std::sin(angle)};
        light.direction = -glm::normalize(light.position);
        light.intensity = glm::vec3(9, 8, 7);
        light.range = 9.0f;
        scene.lights.push_back(light);
    }
    return scene;
}

RenderSettings glass_settings(uint gbuffer = GBUFFER_FULL) {
    RenderSettings settings = small_settings(96, 96, 0);
    settings.gbuffer = gbuffer;
    settings.ambient = 0.1f;
    return settings;
}

// Whether the pixel shows surfaces that face the camera, in every layer.
bool is_inside(const std::vector<SurfaceSamples>& layers, std::size_t i, bool orthographic) {
    return std::ranges::all_of(layers, [&](const SurfaceSamples& layer) {
        const SurfaceSample& s = layer.pixels[i];
        return s.kind == SurfaceKind::background ||
               (orthographic ? s.normal.z : glm::dot(s.normal, -glm::normalize(s.position))) > 0.2;
    });
}

// Relative differences at the pixels off the sphere's silhouette.
std::vector<double> glass_differences(const Scene& scene, const RenderSettings& settings,
                                      const Camera& camera = kGlassCamera) {
    Renderer renderer(scene, settings);
    const Frame frame = renderer.render(camera, 0.0);
    const std::vector<SurfaceSamples> layers =
        RayCaster(scene).cast_layers(camera, settings.width, settings.height);
    const ReferencePicture expected =
        shade_reference(layers, reference_lights(scene.lights, camera, &scene),
                        reference_options(renderer, camera));
    EXPECT_EQ(layers.size(), 4u);
    std::vector<double> out;
    for (std::size_t i = 0; i < frame.radiance.size(); ++i) {
        const double right = expected.radiance.rgb[i];
        if (layers[0].pixels[i / 3].kind == SurfaceKind::background) continue;
        if (!is_inside(layers, i / 3, camera.orthographic)) continue;
        out.push_back(std::abs(frame.radiance[i] - right) / right);
    }
    return out;
}

TEST(Glass, EveryRendererShowsTheFloat64Reference) {
    const Scene scene = glass_scene();
    for (const RendererKind renderer : {RendererKind::deferred, RendererKind::deferred_all,
                                        RendererKind::forward, RendererKind::forward_plus}) {
        RenderSettings settings = glass_settings();
        settings.renderer = renderer;
        const std::vector<double> found = glass_differences(scene, settings);
        EXPECT_GT(found.size(), 9000u);
        EXPECT_LT(quantile(found, 0.5), 2e-5) << static_cast<int>(renderer);
        EXPECT_LT(quantile(found, 0.99), 5e-4) << static_cast<int>(renderer);
    }
    EXPECT_LT(quantile(glass_differences(scene, glass_settings(GBUFFER_PACKED)), 0.5), 1e-2);
}

TEST(Glass, EveryShadingModelLetsLightThrough) {
    const Scene scene = glass_scene();
    for (const Shading shading : {Shading::lambert, Shading::blinn_phong}) {
        RenderSettings settings = glass_settings();
        settings.shading = shading;
        EXPECT_LT(quantile(glass_differences(scene, settings), 0.5), 2e-5)
            << static_cast<int>(shading);
    }
}

TEST(Glass, CastsTintedShadowsOrNone) {
    const Scene scene = glass_scene();
    for (const bool opaque : {false, true}) {
        RenderSettings settings = glass_settings();
        settings.shadows = Shadows::exact;
        settings.opaque_shadows = opaque;
        const std::vector<double> found = glass_differences(scene, settings);
        EXPECT_LT(quantile(found, 0.5), 2e-5) << opaque;
        EXPECT_LT(quantile(found, 0.98), 5e-4) << opaque;
    }
}

// Maps of the second set of coordinates, and colours of vertices.
TEST(Glass, ShadowsAreTintedByEveryAttribute) {
    Scene scene = glass_scene();
    for (const std::size_t pane : {1u, 2u}) {
        Mesh& mesh = scene.meshes[pane];
        mesh.texcoords[1] = {{0.2f, 0.9f}, {0.8f, 1}, {0.7f, 0.1f}, {0.1f, 0}};
        mesh.colors = {{1, 0.5f, 1, 1}, {1, 1, 0.3f, 1}, {0.4f, 1, 1, 1}, {1, 1, 1, 1}};
        scene.materials[pane].transmission_texture = add_noise(scene, 4, 20, {64, 0, 0});
        scene.materials[pane].transmission_texture.uv_set = 1;
        scene.materials[pane].base_color_texture = add_noise(scene, 4, 21, {64, 64, 64});
    }
    RenderSettings settings = glass_settings();
    settings.shadows = Shadows::exact;
    const std::vector<double> found = glass_differences(scene, settings);
    EXPECT_LT(quantile(found, 0.5), 3e-5);
    EXPECT_LT(quantile(found, 0.95), 2e-3);
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

// A lamp before panes that darken a wall: colour^panes, in any order of the panes.
TEST(Glass, SharesOfShadowsMultiply) {
    Material wall;
    wall.metallic = 0.0f;
    wall.roughness = 1.0f;
    Material red = glass({0.9f, 0.4f, 0.2f}), grey = glass(glm::vec3(0.5f));
    for (Material* m : {&red, &grey}) m->ior = 1.0f;
    grey.transmission = 0.0f;
    grey.alpha_mode = AlphaMode::blend;
    grey.base_color.w = 0.25f;
    const auto picture_of = [&](const std::vector<Material>& panes, int lanes) {
        Scene scene;
        add_glass_pane(scene, wall, -1.0, 0.0);
        double z = 0.0;
        for (const Material& pane : panes) add_glass_pane(scene, pane, z += 0.1, 0.0);
        SceneLight lamp;
        lamp.position = {0.0, 0.0, 3.0};
        lamp.intensity = glm::vec3(9.0f);
        lamp.range = 20.0f;
        scene.lights.push_back(lamp);
        RenderSettings settings = small_settings(17, 17, 0);
        settings.gbuffer = GBUFFER_FULL;
        settings.shading = Shading::lambert;
        settings.ambient = 0.0f;
        settings.shadows = Shadows::exact;
        settings.kernels.lanes = lanes;
        // From between the panes and the wall.
        return Renderer(scene, settings)
            .render(look_at({0, 0, -0.2}, {0, 0, -1}, {0, 1, 0}, 0.5), 0.0)
            .radiance;
    };
    const std::vector<float> bare = picture_of({}, 1);
    const std::vector<float> tinted = picture_of({red, grey, red}, 1);
    for (std::size_t i = 0; i < bare.size(); ++i) {
        const double red_share = red.base_color[static_cast<int>(i % 3)];
        ASSERT_NEAR(tinted[i], bare[i] * red_share * red_share * 0.75, 3e-6 * bare[i]) << i;
    }
    EXPECT_EQ(picture_of({grey, red, red}, 1), tinted);
    EXPECT_EQ(picture_of({red, red, grey}, 4), tinted);
}

TEST(Glass, ListsAndAllLightsAreTheSameBits) {
    const Scene scene = glass_scene();
    RenderSettings settings = small_settings(96, 96, 200);
    settings.shadows = Shadows::exact;
    const Frame listed = Renderer(scene, settings).render(kGlassCamera, 0.0);
    settings.kernels.lanes = 4;
    EXPECT_EQ(Renderer(scene, settings).render(kGlassCamera, 0.0).radiance, listed.radiance);
    settings.renderer = RendererKind::deferred_all;
    EXPECT_EQ(Renderer(scene, settings).render(kGlassCamera, 0.0).radiance, listed.radiance);
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

TEST(Glass, ABlackTextureIsTheMaterialWithoutIt) {
    Scene scene = glass_scene();
    scene.images.push_back({"black", 1, 1, {0, 0, 0, 255}});
    scene.textures.push_back({static_cast<int>(scene.images.size()) - 1, {}});
    for (Material& m : scene.materials) {
        m.alpha_mode = AlphaMode::opaque;
        m.transmission_texture = {static_cast<int>(scene.textures.size()) - 1, 0, glm::mat3(1.0f)};
    }
    for (const uint layout : {GBUFFER_PACKED, GBUFFER_FULL}) {
        const RenderSettings settings = glass_settings(layout);
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
            RenderSettings settings = glass_settings();
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
    RenderSettings settings = glass_settings();
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
    RenderSettings settings = glass_settings();
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
    RenderSettings settings = glass_settings();
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
