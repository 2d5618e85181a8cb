// SPDX-License-Identifier: Apache-2.0
// Lights of emissive triangles.
#include "host/scene/lights/glow/glowing_surfaces.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "host/base/formats/srgb.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_shape.h"
#include "tests/scene/expect_near.h"
#include "tests/support/box_scene.h"
#include "tests/support/messages.h"
#include "tests/support/quad_scene.h"
#include "tests/support/sphere_scene.h"

namespace kilolux {
namespace {

struct Glow {
    std::vector<SceneLight> lights;
    GlowCounts counts;
};

Glow glow_of(const Scene& scene) {
    GlowingSurfaces surfaces(std::make_shared<LoadBudget>(std::uint64_t{1} << 30));
    std::vector<SceneLight> lights = surfaces.lights(glowing_parts(scene));
    return {std::move(lights), surfaces.counts()};
}

Material emitting(const glm::vec3& emissive) {
    Material material;
    material.emissive = emissive;
    return material;
}

// One mesh in one instance.
Scene scene_with(Mesh mesh, const Material& material = emitting({4, 2, 1})) {
    Scene scene;
    scene.name = "glow";
    scene.materials.push_back(material);
    mesh.material = 0;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({0, glm::dmat4(1.0)});
    return scene;
}

Mesh one_triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    Mesh mesh;
    mesh.positions = {a, b, c};
    mesh.indices = {0, 1, 2};
    return mesh;
}

// Right-angled at its last vertex, of 3 m^2, towards +Z; (u, v) is (x, y) / (3, 2).
Scene one_triangle_scene(const Material& material = emitting({4, 2, 1})) {
    Mesh mesh = one_triangle({3, 0, 5}, {0, 2, 5}, {0, 0, 5});
    mesh.texcoords[0] = {{1, 0}, {0, 1}, {0, 0}};
    return scene_with(mesh, material);
}

TextureUse add_glow_image(Scene& scene, int width, std::vector<std::uint8_t> rgba, Filter filter,
                          Wrap wrap = Wrap::repeat) {
    const int height = static_cast<int>(rgba.size()) / (4 * width);
    scene.images.push_back({"image", width, height, std::move(rgba)});
    Texture texture{static_cast<int>(scene.images.size()) - 1, {}};
    texture.sampler.magnify = filter;
    texture.sampler.wrap_s = texture.sampler.wrap_t = wrap;
    scene.textures.push_back(texture);
    TextureUse use;
    use.texture = static_cast<int>(scene.textures.size()) - 1;
    return use;
}

// Luminance of a flat light [nit].
glm::dvec3 nits_of(const SceneLight& light) {
    return glm::dvec3(light.intensity) / seen_area(light);
}

TEST(GlowingSurfaces, ATriangleIsALightOfItsEmission) {
    const Glow glow = glow_of(one_triangle_scene());
    ASSERT_EQ(glow.lights.size(), 1u);
    const SceneLight& light = glow.lights[0];
    EXPECT_EQ(light.type, LightType::triangle);
    expect_near(light.direction, {0, 0, 1});
    expect_near(light.position, {1.0, 2.0 / 3.0, 5.0});
    EXPECT_NEAR(seen_area(light), 3.0, 1e-6);
    expect_near(glm::dvec3(light.intensity), {12, 6, 3});
    EXPECT_EQ(light.range, 0.0f);
    EXPECT_FALSE(light.two_sided);
    EXPECT_TRUE(light.of_surface);
    EXPECT_EQ(glow.counts.triangles, 1u);
    EXPECT_EQ(glow.counts.meshes, 1u);
    EXPECT_EQ(glow.counts.rectangles, 0u);
}

TEST(GlowingSurfaces, ShineToTheSideThatIsDrawn) {
    Scene scene = one_triangle_scene();
    // Mirrors turn the winding in the world, not the front.
    const std::pair<glm::dvec3, double> cases[] = {{{-1, 1, 1}, 1.0},
                                                   {{1, -1, 1}, 1.0},
                                                   {{1, 1, -1}, -1.0},
                                                   {{-1, -1, -1}, -1.0},
                                                   {{2, 1, 1}, 1.0}};
    for (const auto& [scale, z] : cases) {
        scene.instances[0].world_from_object = glm::scale(glm::dmat4(1.0), scale);
        const Glow glow = glow_of(scene);
        ASSERT_EQ(glow.lights.size(), 1u);
        expect_near(glow.lights[0].direction, {0.0, 0.0, z});
        EXPECT_NEAR(seen_area(glow.lights[0]), 3.0 * std::abs(scale.x), 1e-6);
        expect_near(nits_of(glow.lights[0]), {4, 2, 1});
    }
    scene.materials[0].double_sided = true;
    EXPECT_TRUE(glow_of(scene).lights.at(0).two_sided);
}

TEST(GlowingSurfaces, PairsOfTrianglesAreRectangles) {
    const Glow box = glow_of(scene_with(box_mesh({2, 3, 4})));
    ASSERT_EQ(box.lights.size(), 6u);
    EXPECT_EQ(box.counts.triangles, 12u);
    EXPECT_EQ(box.counts.rectangles, 6u);
    for (const SceneLight& light : box.lights) {
        EXPECT_EQ(light.type, LightType::rectangle);
        EXPECT_GT(glm::dot(light.direction, light.position), 0.0) << "outwards";
        expect_near(nits_of(light), {4, 2, 1});
        const LightEdges edges = edges_of(light);
        const glm::dvec3 corner = light.position + edges.x + edges.y;
        expect_near(glm::abs(corner), {1, 1.5, 2});
    }
    // Where it is turned and large, far away.
    Scene scene = scene_with(quad(0.3f));
    scene.instances[0].world_from_object =
        glm::rotate(glm::translate(glm::dmat4(1.0), {300, 20, -70}), 0.7, glm::dvec3(1, 2, 3));
    EXPECT_EQ(glow_of(scene).counts.rectangles, 1u);
    scene.instances[0].world_from_object[0] *= 2.0;
    EXPECT_EQ(glow_of(scene).counts.rectangles, 1u) << "longer on one side";
    scene.instances[0].world_from_object[0] += 0.01 * scene.instances[0].world_from_object[1];
    EXPECT_EQ(glow_of(scene).counts.rectangles, 0u) << "sheared";
    EXPECT_EQ(glow_of(scene).lights.size(), 2u);
}

TEST(GlowingSurfaces, OtherPairsAreTriangles) {
    Mesh bent = quad(1.0f), twisted = quad(1.0f), kite = quad(1.0f), back = quad(1.0f);
    bent.positions[1].z = 0.01f;
    kite.positions[2] = {1.01f, 1.01f, 0.0f};
    back.indices = {0, 1, 2, 0, 3, 2};
    for (const Mesh& mesh : {bent, kite, back}) {
        const Glow glow = glow_of(scene_with(mesh));
        EXPECT_EQ(glow.lights.size(), 2u);
        EXPECT_EQ(glow.counts.rectangles, 0u);
    }
}

TEST(GlowingSurfaces, WithoutEmissionAreNone) {
    Material unlit = emitting({1, 1, 1});
    unlit.unlit = true;
    const Material endless = emitting(glm::vec3(std::numeric_limits<float>::infinity()));
    for (const Material& material : {Material{}, unlit, endless}) {
        EXPECT_TRUE(glow_of(one_triangle_scene(material)).lights.empty());
    }
    Scene scene = one_triangle_scene();
    scene.materials[0].emissive_texture = add_glow_image(scene, 1, {0, 0, 0, 255}, Filter::linear);
    EXPECT_TRUE(glow_of(scene).lights.empty());
    scene = one_triangle_scene();
    scene.meshes[0].material = kDefaultMaterial;
    EXPECT_TRUE(glow_of(scene).lights.empty());
}

TEST(GlowingSurfaces, WithoutAnAreaAreCounted) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const glm::vec3 corners[][3] = {
        {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}},           {{0, 0, 0}, {1, 0, 0}, {0.5f, 0, 0}},
        {{0, 0, 0}, {1, 0, 0}, {0.5f, 1e-12f, 0}},   {{0, 0, 0}, {1e-30f, 0, 0}, {0, 1e-30f, 0}},
        {{1, 1, 1}, {1, 1, 1}, {2, 2, 2}},           {{nan, 0, 0}, {1, 0, 0}, {0, 1, 0}},
        {{0, 0, 0}, {1e-12f, 0, 0}, {0, 1e-12f, 0}}, {{3e38f, 0, 0}, {0, 3e38f, 0}, {0, 0, 3e38f}}};
    Scene scene = scene_with(one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
    Mesh& mesh = scene.meshes[0];
    for (const auto& [a, b, c] : corners) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {a, b, c});
        mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2});
    }
    const Glow glow = glow_of(scene);
    EXPECT_EQ(glow.counts.triangles + glow.counts.left_out, 9u);
    EXPECT_EQ(glow.counts.triangles, 2u) << "the whole one and a speck";
    ASSERT_EQ(glow.lights.size(), 2u);
    for (const SceneLight& light : glow.lights) {
        EXPECT_TRUE(has_good_numbers([&] {
            SceneLight with_range = light;
            with_range.range = 1.0f;
            return with_range;
        }()));
        EXPECT_TRUE(is_finite(light.position) && is_finite(light.direction));
        EXPECT_TRUE(is_finite(light.side) && is_finite(glm::dvec3(light.intensity)));
    }
    EXPECT_TRUE(contains(text_of(glow.counts),
                         "7 triangles are left out: no area, or values out of range"));
}

// Of codes that are 1 where u < 1/2: three quarters of the triangle.
TEST(GlowingSurfaces, MapsAreAveragedOverTheTriangle) {
    Scene scene = one_triangle_scene();
    scene.materials[0].emissive_texture =
        add_glow_image(scene, 2, {255, 255, 255, 255, 0, 0, 0, 255}, Filter::nearest);
    const Glow glow = glow_of(scene);
    ASSERT_EQ(glow.lights.size(), 1u);
    const glm::dvec3 mean = nits_of(glow.lights[0]);
    EXPECT_NEAR(mean.x, 3.0, 0.02);
    EXPECT_NEAR(mean.x / mean.z, 4.0, 1e-6);
    EXPECT_EQ(glow.counts.varied, 1u);
    EXPECT_NEAR(glow.counts.deviation, std::sqrt((0.75 - 0.5625)) / 0.75, 5e-3);
    EXPECT_TRUE(contains(text_of(glow.counts), "differs from its mean by 57"))
        << text_of(glow.counts);
}

// Linear between the middles of two texels: of u, integrated with the weight 2 (1 - u).
TEST(GlowingSurfaces, MapsAreFilteredInLinearLight) {
    Scene scene = one_triangle_scene();
    scene.materials[0].emissive_texture =
        add_glow_image(scene, 2, {0, 0, 0, 255, 188, 188, 188, 255}, Filter::linear, Wrap::clamp);
    // 0 until u = 1/4, then 2 (u - 1/4) until 3/4, then 1.
    const auto to = [](double u) {
        return 2.0 * (u * u / 2 - u * u * u / 3) - (u - u * u / 2) / 2;
    };
    const double mean = 2.0 * (to(0.75) - to(0.25)) + 1.0 / 16.0;
    EXPECT_NEAR(nits_of(glow_of(scene).lights.at(0)).x, 4.0 * srgb_to_linear(188 / 255.0) * mean,
                2e-3);
}

// All of a repeating map, twice and a half, through its transform and the other coordinates.
TEST(GlowingSurfaces, MapsAreReadAsTheRendererReadsThem) {
    Scene scene = scene_with(quad(1.0f), emitting({1, 1, 1}));
    TextureUse use = add_noise(scene, 64, 3, {0, 0, 0});
    use.uv_set = 1;
    use.uv_from_texcoord = glm::mat3({0, 3, 0}, {-2, 0, 0}, {0.3f, 0.1f, 1});
    scene.materials[0].emissive_texture = use;
    scene.meshes[0].texcoords[1] = scene.meshes[0].texcoords[0];
    scene.meshes[0].texcoords[0].assign(4, {0, 0});
    const Image& image = scene.images[0];
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < image.rgba.size(); ++i) {
        if (i % 4 != 3)
            sum[static_cast<glm::length_t>(i % 4)] += srgb_to_linear(image.rgba[i] / 255.0);
    }
    const Glow glow = glow_of(scene);
    ASSERT_EQ(glow.lights.size(), 2u);
    const glm::dvec3 mean = 0.5 * (nits_of(glow.lights[0]) + nits_of(glow.lights[1]));
    for (glm::length_t c = 0; c < 3; ++c) EXPECT_NEAR(mean[c] / (sum[c] / 4096.0), 1.0, 2e-3) << c;
}

// Fewer points than texels miss no pattern: every second column is dark.
TEST(GlowingSurfaces, NoPatternOfALargeMapIsMissed) {
    Scene scene = one_triangle_scene(emitting({1, 1, 1}));
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < 1024 * 64; ++i) {
        const auto code = static_cast<std::uint8_t>(i % 2 == 0 ? 255 : 0);
        rgba.insert(rgba.end(), {code, code, code, 255});
    }
    scene.materials[0].emissive_texture = add_glow_image(scene, 1024, rgba, Filter::nearest);
    EXPECT_NEAR(nits_of(glow_of(scene).lights.at(0)).x, 0.5, 0.01);
}

TEST(GlowingSurfaces, AMapWithoutAPatternMergesRectangles) {
    Scene scene = scene_with(quad(1.0f));
    scene.materials[0].emissive_texture = add_texel(scene, {188, 255, 0, 255});
    const Glow glow = glow_of(scene);
    ASSERT_EQ(glow.lights.size(), 1u);
    expect_near(nits_of(glow.lights[0]), {4.0 * srgb_to_linear(188 / 255.0), 2.0, 0.0});
    EXPECT_EQ(glow.counts.varied, 0u);
}

TEST(GlowingSurfaces, WeighByTheirCoverage) {
    Scene scene = one_triangle_scene();
    scene.materials[0].base_color.w = 0.25f;
    expect_near(nits_of(glow_of(scene).lights.at(0)), {4, 2, 1});
    scene.materials[0].alpha_mode = AlphaMode::blend;
    expect_near(nits_of(glow_of(scene).lights.at(0)), {1, 0.5, 0.25});
    scene.materials[0].alpha_mode = AlphaMode::mask;
    EXPECT_TRUE(glow_of(scene).lights.empty());
    scene.meshes[0].colors = {{1, 1, 1, 4}, {1, 1, 1, 0}, {1, 1, 1, 0}};  // of u: 1 until 1/2
    scene.materials[0].alpha_cutoff = 0.5f;
    EXPECT_NEAR(nits_of(glow_of(scene).lights.at(0)).x, 4.0 * 0.25, 0.3);
    scene = one_triangle_scene();
    scene.materials[0].alpha_mode = AlphaMode::mask;
    scene.materials[0].base_color_texture =
        add_glow_image(scene, 2, {9, 9, 9, 255, 9, 9, 9, 0}, Filter::nearest);
    EXPECT_NEAR(nits_of(glow_of(scene).lights.at(0)).x, 3.0, 0.02);
}

TEST(GlowingSurfaces, AreTheSameOnAnyNumberOfThreads) {
    Scene scene = sphere_scene(emitting({1, 2, 3}));
    scene.materials[0].emissive_texture = add_noise(scene, 32, 5, {0, 0, 0});
    scene.instances.push_back({0, glm::translate(glm::dmat4(1.0), {3, 0, 0})});
    const Glow many = glow_of(scene);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(glow_of(scene).lights, many.lights);
    EXPECT_GT(many.lights.size(), 15'000u);
    EXPECT_EQ(many.counts.meshes, 1u);
    EXPECT_GT(many.counts.left_out, 0u) << "at the poles";
}

TEST(GlowingSurfaces, BeyondTheMemoryFailInOneLine) {
    GlowingSurfaces surfaces(std::make_shared<LoadBudget>(1000));
    const Scene scene = scene_with(box_mesh({1, 1, 1}));
    const std::string message =
        message_of<MemoryError>([&] { surfaces.lights(glowing_parts(scene)); });
    EXPECT_TRUE(message.starts_with("glow: lights of glowing surfaces: needs ")) << message;
    EXPECT_FALSE(contains(message, "\n"));
}

TEST(GlowingSurfaces, ReturnTheirMemory) {
    const auto budget = std::make_shared<LoadBudget>(200'000);
    AnimatedScene scene(scene_with(box_mesh({1, 1, 1})));
    const Scene box = scene_with(box_mesh({1, 1, 1}));
    for (int i = 0; i < 1000; ++i) GlowingSurfaces(budget).lights(glowing_parts(box));
    GlowingSurfaces kept(budget);
    for (int i = 0; i < 1000; ++i) kept.lights(glowing_parts(box));
}

TEST(GlowingSurfaces, StandBetweenTheScenesOwnAndAddedLights) {
    Scene made = scene_with(quad(1.0f));
    made.lights.resize(2);
    AnimatedScene scene(made);
    scene.add_lights(std::vector<SceneLight>(3));
    const auto of_surfaces = [&] {
        std::string out;
        for (const SceneLight& light : scene.scene().lights) out += light.of_surface ? 's' : '.';
        return out;
    };
    EXPECT_EQ(scene.glow(), nullptr);
    const std::uint32_t before = scene.scene().revisions.lights;
    scene.light_by_surfaces(true);
    EXPECT_EQ(of_surfaces(), "..s...");
    EXPECT_EQ(scene.glow()->rectangles, 1u);
    EXPECT_EQ(scene.scene().revisions.lights, before + 1);
    scene.light_by_surfaces(true);
    EXPECT_EQ(scene.scene().revisions.lights, before + 1);
    scene.replace_lights({});
    EXPECT_EQ(of_surfaces(), "..s");
    scene.light_by_surfaces(false);
    EXPECT_EQ(of_surfaces(), "..");
    EXPECT_EQ(scene.glow(), nullptr);
}

}  // namespace
}  // namespace kilolux
