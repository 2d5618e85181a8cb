// SPDX-License-Identifier: Apache-2.0
// Pictures of grouped lights: within their bound, and the same for all renderer settings.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "host/base/error.h"
#include "host/certify/tail_scenarios.h"
#include "tests/support/render_fixture.h"
#include "tests/support/sphere_scene.h"

namespace kilolux {
namespace {

// The grid with every kind of light, and `count` points without a range over it.
Scene scene_of_points(int count) {
    Scene scene = grid_with_every_light();
    const Box box = bounds(scene);
    for (int i = 0; i < count; ++i) {
        SceneLight light;
        light.position = {box.min.x + std::fmod(0.6180339 * i, 1.0) * box.size().x,
                          box.max.y + 0.3 + std::fmod(0.3247 * i, 2.0),
                          box.min.z + std::fmod(0.7548776 * i, 1.0) * box.size().z};
        light.intensity = {1.0f + static_cast<float>(i % 5), 3.0f, 2.0f};
        scene.lights.push_back(light);
    }
    return scene;
}

RenderSettings tree_settings(float share) {
    RenderSettings settings = small_settings(160, 90, 0);
    settings.tails = Tails::tree;
    settings.tree_share = share;
    settings.gbuffer = GBUFFER_FULL;
    return settings;
}

TailAgreement compare(const Scene& scene, const RenderSettings& settings) {
    return compare_tails({"", scene, first_camera(scene)}, settings);
}

TEST(LightTreePictures, GroupsOfOneAreTheUnlimitedLights) {
    const TailAgreement found = compare(scene_of_points(300), tree_settings(0.0f));
    EXPECT_GT(found.values, 10000);
    EXPECT_LE(found.largest_error, 1e-5);
}

TEST(LightTreePictures, ErrWithinTheirBound) {
    Scene scene = scene_of_points(2000);
    for (Material& material : scene.materials) material.roughness = 0.3f;  // narrow lobes
    for (const Shading shading : {Shading::lambert, Shading::blinn_phong, Shading::pbr}) {
        for (const float share : {1.0f, 10.0f}) {
            RenderSettings settings = tree_settings(share);
            settings.width = 96;
            settings.height = 54;
            settings.shading = shading;
            const TailAgreement found = compare(scene, settings);
            EXPECT_EQ(found.below, 0) << share;
            EXPECT_GT(found.looseness.size(), 500u) << share;  // it groups
            EXPECT_LE(found.largest_error, 0.5 * share);
        }
    }
}

TailAgreement compare_coated(const Scene& scene, Tails tails) {
    RenderSettings settings = tree_settings(10.0f);
    settings.width = settings.height = 48;
    settings.tails = tails;
    settings.range_budget = 0.05;
    const Camera camera = look_at({0.5, 0.8, 4.0}, {0, 0, 0}, {0, 1, 0}, 0.55);
    return compare_tails({"", scene, camera}, settings);
}

// Points without a range in the box from `low` to `high`.
void add_points(Scene& scene, int count, const glm::dvec3& low, const glm::dvec3& high) {
    for (int i = 0; i < count; ++i) {
        SceneLight light;
        const glm::dvec3 share(std::fmod(0.6180339 * i, 1.0), std::fmod(0.3247 * i, 1.0),
                               std::fmod(0.7548776 * i, 1.0));
        light.position = low + share * (high - low);
        light.intensity = {1.0f, 3.0f, 2.0f};
        scene.lights.push_back(light);
    }
}

TEST(LightTreePictures, ErrWithinTheirBoundUnderCoats) {
    Scene scene = car_paint_scene();
    scene.materials[0].normal_scale = 2.0f;
    add_points(scene, 1500, {-4.5, 1.0, -4.5}, {4.5, 3.0, 4.5});
    for (const Tails tails : {Tails::tree, Tails::bounded}) {
        const TailAgreement found = compare_coated(scene, tails);
        EXPECT_EQ(found.below, 0);
        EXPECT_GT(found.looseness.size(), 500u);
    }
}

// Over black, where sheen is all light, lit from the eye's side; and narrow over white, where it
// dims what comes in at grazing angles.
TEST(LightTreePictures, ErrWithinTheirBoundWithSheen) {
    for (const float white : {0.0f, 1.0f}) {
        Scene scene = cloth_scene();
        Material& m = scene.materials[0];
        m.base_color = glm::vec4(white, white, white, 1.0f);
        m.specular = m.metallic = 0.0f;
        m.roughness = 1.0f;
        m.sheen_roughness = white > 0.0f ? 0.0f : 0.6f;
        m.sheen_color = glm::vec3(1.0f);
        m.normal_texture = m.sheen_color_texture = m.sheen_roughness_texture = {};
        const double z = white > 0.0f ? -4.5 : 6.0;
        add_points(scene, 1500, {-4.5, 1.0, z}, {4.5, 3.0, z + 9.0});
        for (const Tails tails : {Tails::tree, Tails::bounded}) {
            const TailAgreement found = compare_coated(scene, tails);
            EXPECT_EQ(found.below, 0) << white;
            EXPECT_GT(found.looseness.size(), 100u) << white;
        }
    }
}

// Lights beside the mirror direction, along the highlights, which are all light.
TEST(LightTreePictures, ErrWithinTheirBoundWithAnisotropy) {
    Scene scene = brushed_scene();
    Material& m = scene.materials[0];
    m.normal_texture = m.anisotropy_texture = {};
    m.base_color = glm::vec4(1.0f);
    m.metallic = 1.0f;
    m.roughness = 0.2f;
    m.anisotropy_rotation = 0.0f;
    add_points(scene, 1500, {-4.5, -0.4, 1.5}, {4.5, 0.4, 4.5});
    for (const float strength : {0.3f, 1.0f}) {
        m.anisotropy_strength = strength;
        for (const Tails tails : {Tails::tree, Tails::bounded}) {
            const TailAgreement found = compare_coated(scene, tails);
            EXPECT_EQ(found.below, 0) << strength;
            EXPECT_GT(found.looseness.size(), 500u) << strength;
        }
    }
}

// All surfaces are turned away from all lights, their coats are not.
TEST(LightTreePictures, CountNodesThatOnlyCoatsFace) {
    Scene scene = car_paint_scene();
    scene.materials[0].normal_texture = add_texel(scene, {0, 128, 140, 255});
    scene.materials[0].normal_scale = 1.0f;
    scene.materials[0].clearcoat_normal_texture = {};
    add_points(scene, 300, {5, 0, 1}, {6, 1, 2});
    const TailAgreement found = compare_coated(scene, Tails::tree);
    EXPECT_EQ(found.below, 0);
    EXPECT_GT(found.looseness.size(), 200u);
}

TEST(LightTreePictures, EvaluateFewLights) {
    RenderSettings settings = tree_settings(1.0f);
    settings.shading = Shading::lambert;
    const Frame few = render_once(scene_of_points(4000), settings);
    EXPECT_LT(few.stats.evaluations_per_pixel, 1000.0);
    EXPECT_EQ(few.stats.lights_used, few.stats.lights_given);
    settings.tree_share = 0.0f;
    const Frame all = render_once(scene_of_points(4000), settings);
    EXPECT_GT(all.stats.evaluations_per_pixel, 2000.0);
    EXPECT_LE(all.stats.evaluations_per_pixel, 4013.0);
}

TEST(LightTreePictures, AreTheSameBitsHoweverTheyAreMade) {
    const Scene scene = scene_of_points(3000);
    RenderSettings settings = tree_settings(0.3f);
    settings.lights.count = 50;
    settings.samples = 2;
    const Frame frame = render_once(scene, settings);
    const auto expect_same = [&](const char* what, const std::function<void(RenderSettings&)>& f) {
        RenderSettings other = settings;
        f(other);
        EXPECT_EQ(render_once(scene, other).radiance, frame.radiance) << what;
    };
    expect_same("bands", [](RenderSettings& s) { s.band_rows = 16; });
    expect_same("4 lanes", [](RenderSettings& s) { s.kernels.lanes = 4; });
    expect_same("1 lane", [](RenderSettings& s) { s.kernels.lanes = 1; });
    expect_same("wide indices", [](RenderSettings& s) { s.force_features = {"wide-light-index"}; });
    Renderer changed(scene, tree_settings(0.3f));
    RenderSettings exact = settings;
    exact.tails = Tails::exact;
    changed.change(exact);
    changed.render(first_camera(scene), 0.0);
    changed.change(settings);
    EXPECT_EQ(changed.render(first_camera(scene), 0.0).radiance, frame.radiance);
}

// A pixel of a floor that sees all lights evaluates nodes that count each light once.
TEST(LightTreePictures, EveryLightCountsOnce) {
    Scene scene = make_generated_scene("plain");
    const Box box = bounds(scene);
    float total = 0.0f;
    for (int i = 0; i < 1000; ++i) {
        SceneLight light;
        light.position = {std::fmod(0.6180339 * i, 1.0) * 8.0, box.max.y + 5.0,
                          std::fmod(0.7548776 * i, 1.0) * 8.0};
        light.intensity = glm::vec3(static_cast<float>(1 + i % 4));
        total += light.intensity.x;
        scene.lights.push_back(light);
    }
    Renderer renderer(scene, tree_settings(1.0f));
    renderer.render(first_camera(scene), 0.0);
    int probed = 0;
    for (int x = 5; x < 160; x += 30) {
        const PixelProbe probe = renderer.probe(x, 60);
        if (!probe.has_surface()) continue;
        float found = 0.0f;
        for (const ProbedLight& light : probe.lights) found += light.light.color_scale.x;
        EXPECT_LT(probe.lights.size(), 900u);
        EXPECT_EQ(found, total);
        ++probed;
    }
    EXPECT_GT(probed, 2);
}

TEST(LightTreePictures, AreRefusedWhereThereAreNone) {
    Scene scene = scene_of_points(10);
    RenderSettings settings = tree_settings(0.3f);
    settings.renderer = RendererKind::deferred_all;
    expect_refused(scene, settings, "--renderer deferred");
    settings.renderer = RendererKind::forward;
    expect_refused(scene, settings, "--renderer deferred");
    settings.renderer = RendererKind::deferred;
    settings.shadows = Shadows::exact;
    expect_refused(scene, settings, "no shadows");
    settings.shadows = Shadows::off;
    for (Material& material : scene.materials) material.alpha_mode = AlphaMode::blend;
    expect_refused(scene, settings, "blend or transmit");
}

}  // namespace
}  // namespace kilolux
