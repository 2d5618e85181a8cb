// SPDX-License-Identifier: Apache-2.0
// Lights of emissive meshes: such a mesh does not hide its own light, and references see them.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <numeric>

#include "host/measure/reference/decoded_samples.h"
#include "host/measure/reference/ray_cast_reference.h"
#include "host/scene/animated_scene.h"
#include "tests/render/shadows/soft_scenes.h"
#include "tests/support/box_scene.h"
#include "tests/support/quad_scene.h"

namespace kilolux {
namespace {

constexpr glm::vec3 kEmission{5.0f, 4.0f, 3.0f};

int add_room_mesh(Scene& scene, Mesh mesh, const Material& material) {
    mesh.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(material);
    scene.meshes.push_back(std::move(mesh));
    return static_cast<int>(scene.meshes.size()) - 1;
}

Material matt_material(float albedo = 0.6f) {
    Material material;
    material.base_color = glm::vec4(glm::vec3(albedo), 1.0f);
    material.metallic = 0.0f;
    material.roughness = 0.8f;
    return material;
}

Material glowing_material() {
    Material material = matt_material(0.2f);
    material.emissive = kEmission;
    return material;
}

// A quad of 1.2 m x 1.2 m that faces down at a height; `shear`: no rectangle, and two triangles.
glm::dmat4 panel_place(double height, double shear = 0.0) {
    glm::dmat4 place = glm::translate(glm::dmat4(1.0), {0.3, height, -0.2});
    place = glm::rotate(place, 0.4, glm::dvec3(0, 1, 0));
    place[0] += shear * place[1];
    return glm::rotate(place, 1.5707963267948966, glm::dvec3(1, 0, 0));
}

// A closed room of 6 m x 3 m x 5 m about the origin with a panel in the plane of its ceiling.
Scene room_with_panel(double below_ceiling, double shear = 0.0) {
    Scene scene;
    scene.instances.push_back(
        {add_room_mesh(scene, box_mesh({6, 3, 5}, true), matt_material()), glm::dmat4(1.0)});
    Mesh panel = quad(0.6f);
    for (glm::vec3& p : panel.positions) p.x += static_cast<float>(shear) * p.y;
    scene.instances.push_back(
        {add_room_mesh(scene, panel, glowing_material()), panel_place(1.5 - below_ceiling)});
    return scene;
}

// A ball of 0.5 m of 1,104 triangles.
Mesh ball_mesh() {
    constexpr std::uint32_t kRings = 24, kColumns = 24;
    Mesh mesh;
    for (std::uint32_t ring = 0; ring <= kRings; ++ring) {
        for (std::uint32_t column = 0; column < kColumns; ++column) {
            const double from_top = std::numbers::pi * ring / kRings,
                         around = 2.0 * std::numbers::pi * column / kColumns;
            const glm::dvec3 n(std::sin(from_top) * std::sin(around), std::cos(from_top),
                               std::sin(from_top) * std::cos(around));
            mesh.positions.emplace_back(0.5 * n);
            mesh.normals.emplace_back(n);
        }
    }
    for (std::uint32_t ring = 0; ring < kRings; ++ring) {
        for (std::uint32_t column = 0; column < kColumns; ++column) {
            const std::uint32_t a = ring * kColumns + column,
                                b = ring * kColumns + (column + 1) % kColumns;
            for (const std::uint32_t i : {a, a + kColumns, b, b, a + kColumns, b + kColumns}) {
                mesh.indices.push_back(i);
            }
        }
    }
    return mesh;
}

void add_low_table(Scene& scene) {
    const glm::dmat4 place =
        glm::rotate(glm::translate(glm::dmat4(1.0), {0.5, -0.5, 0.0}), 0.3, glm::dvec3(0, 1, 0));
    scene.instances.push_back(
        {add_room_mesh(scene, box_mesh({1.3, 0.1, 0.9}), matt_material(0.4f)), place});
}

// With the lights of its surfaces.
Scene lit_by_surfaces(const Scene& scene) {
    AnimatedScene out(scene);
    out.light_by_surfaces(true);
    return std::move(out).take();
}

void move_scene(Scene& scene, Camera& camera, const glm::dmat4& by) {
    for (Instance& instance : scene.instances) {
        instance.world_from_object = by * instance.world_from_object;
    }
    camera.position = glm::dvec3(by * glm::dvec4(camera.position, 1.0));
    camera.world_from_view = glm::dmat3(by) * camera.world_from_view;
}

Camera room_camera() { return look_at({-2.6, 0.9, 2.1}, {0.6, -0.4, -0.5}, {0, 1, 0}, 1.2); }

double picture_sum(const std::vector<float>& radiance) {
    return std::accumulate(radiance.begin(), radiance.end(), 0.0);
}

// Of the sum of `exact`.
template <typename A, typename B>
double picture_error(const std::vector<A>& picture, const std::vector<B>& exact) {
    double error = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        error += std::abs(double{picture[i]} - double{exact[i]});
        sum += exact[i];
    }
    return error / sum;
}

// Where nothing is between light and surfaces: not even the panel and the ceiling in its plane. Of
// surfaces in that plane the light itself is rounding, and dark: of 2,304 pixels a few per cent.
void expect_no_noise(Scene scene, const Camera& camera, const RenderSettings& base,
                     int most_in_plane) {
    scene = lit_by_surfaces(scene);
    RenderSettings settings = base;
    settings.want.aovs = {"error-standard"};
    const Frame sampled = Renderer(scene, settings).render(camera, 0.0);
    settings.want.aovs.clear();
    settings.shadows = Shadows::off;
    const Frame whole = Renderer(scene, settings).render(camera, 0.0);
    EXPECT_GT(picture_sum(whole.radiance), 100.0);
    int in_plane = 0;
    for (std::size_t i = 0; i < whole.radiance.size() / 3; ++i) {
        const float light = luminance_of(whole.radiance, i);
        const bool equal = luminance_of(sampled.radiance, i) == light;
        const float error = sampled.aovs.front().values[i];
        if (equal && error == 0.0f) continue;
        ++in_plane;
        EXPECT_LT(light, 1e-6f) << i;
        EXPECT_LT(error, 1e-6f) << i;
    }
    EXPECT_LE(in_plane, most_in_plane);
}

TEST(GlowingShadows, APanelDoesNotHideItsOwnLight) {
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(1, 2, 3));
    const glm::dmat4 places[] = {glm::dmat4(1.0), turned,
                                 glm::translate(glm::dmat4(1.0), {40, 7, -90}) * turned};
    for (const bool in_ceiling : {false, true}) {
        for (const glm::dmat4& place : places) {
            SCOPED_TRACE(testing::Message() << in_ceiling << " " << place[3].x);
            Scene scene = in_ceiling ? room_with_panel(0.0, 0.3) : room_with_panel(0.01);
            Camera camera = room_camera();
            move_scene(scene, camera, place);
            expect_no_noise(scene, camera, soft_settings(64, 36, 8), in_ceiling ? 100 : 0);
        }
    }
}

// Rays of a narrow lobe are turned to its space and back.
TEST(GlowingShadows, APanelDoesNotHideItsOwnHighlights) {
    for (const float roughness : {0.05f, 0.3f}) {
        Scene scene = room_with_panel(0.0, 0.2);
        scene.materials[0].metallic = 1.0f;
        scene.materials[0].roughness = roughness;
        RenderSettings settings = soft_settings(64, 36, 8);
        settings.shading = Shading::pbr;
        SCOPED_TRACE(roughness);
        expect_no_noise(scene, room_camera(), settings, 100);
    }
}

// A light 1 mm below the panel instead: the same light but for that, and a strip of its edge.
TEST(GlowingShadows, APanelIsARectangleLightBeforeIt) {
    Scene scene = room_with_panel(0.01);
    add_low_table(scene);
    const Scene glow = lit_by_surfaces(scene);
    ASSERT_EQ(glow.lights.size(), 1u);
    Scene before = scene;
    before.lights = glow.lights;
    before.lights[0].position += 1e-3 * before.lights[0].direction;
    const RenderSettings settings = soft_settings(64, 36, 16);
    const Frame a = Renderer(glow, settings).render(room_camera(), 0.0);
    const Frame b = Renderer(before, settings).render(room_camera(), 0.0);
    EXPECT_LT(picture_error(a.radiance, b.radiance), 0.004);
    RenderSettings off = settings;
    off.shadows = Shadows::off;
    const Frame whole = Renderer(glow, off).render(room_camera(), 0.0);
    EXPECT_GT(picture_error(a.radiance, whole.radiance), 0.02) << "the table casts a shadow";
}

// A convex mesh hides no face that shines towards a point.
TEST(GlowingShadows, ACurvedMeshIsNotBlack) {
    Scene scene;
    scene.instances.push_back(
        {add_room_mesh(scene, box_mesh({6, 3, 5}, true), matt_material()), glm::dmat4(1.0)});
    scene.instances.push_back({add_room_mesh(scene, ball_mesh(), glowing_material()),
                               glm::translate(glm::dmat4(1.0), {0.4, 0.3, -0.3})});
    scene = lit_by_surfaces(scene);
    EXPECT_GT(scene.lights.size(), 900u);
    RenderSettings settings = soft_settings(48, 27, 8);
    settings.tails = Tails::exact;
    const Frame sampled = Renderer(scene, settings).render(room_camera(), 0.0);
    settings.shadows = Shadows::off;
    const Frame whole = Renderer(scene, settings).render(room_camera(), 0.0);
    EXPECT_LT(picture_error(sampled.radiance, whole.radiance), 1e-4);
    // The same as a sphere of that luminance.
    Scene sphere = scene;
    SceneLight light;
    light.type = LightType::sphere;
    light.radius = 0.5f;
    light.position = {0.4, 0.3, -0.3};
    light.intensity = kEmission * 0.25f * std::numbers::pi_v<float>;
    sphere.lights = {light};
    const Frame round = Renderer(sphere, settings).render(room_camera(), 0.0);
    EXPECT_LT(picture_error(whole.radiance, round.radiance), 0.02);
}

TEST(GlowingShadows, ListsChangeNoBit) {
    Scene scene = room_with_panel(0.01, 0.3);
    add_low_table(scene);
    scene = lit_by_surfaces(scene);
    for (const Shadows shadows : {Shadows::off, Shadows::sampled}) {
        RenderSettings settings = soft_settings(64, 36, 4);
        settings.shading = Shading::pbr;
        settings.shadows = shadows;
        const Frame listed = Renderer(scene, settings).render(room_camera(), 0.0);
        settings.renderer = RendererKind::deferred_all;
        EXPECT_EQ(Renderer(scene, settings).render(room_camera(), 0.0).radiance, listed.radiance);
    }
}

TEST(GlowingShadows, ReferencesSeeThem) {
    Scene scene = room_with_panel(0.01);
    add_low_table(scene);
    scene = lit_by_surfaces(scene);
    const Camera camera = room_camera();
    RenderSettings settings = soft_settings(32, 18, 256);
    settings.gbuffer = GBUFFER_FULL;
    Renderer renderer(scene, settings);
    const Frame frame = renderer.render(camera, 0.0);
    ReferenceOptions options = reference_options(renderer, camera);
    const LitSurfaces lit = renderer.lit_surfaces();
    EXPECT_LT(picture_error(frame.radiance, shade_reference(lit, options).radiance.rgb), 0.005);
    const ReferencePicture traced =
        shade_reference(RayCaster(scene).cast(camera, settings.width, settings.height),
                        reference_lights(scene.lights, camera, &scene), options);
    EXPECT_LT(picture_error(frame.radiance, traced.radiance.rgb), 0.01);
    options.shadows = {};
    EXPECT_GT(picture_error(frame.radiance, shade_reference(lit, options).radiance.rgb), 0.02);
}

// In double precision panel and ceiling do not hide it either.
TEST(GlowingShadows, ReferencesAreNotBlackBelowAPanel) {
    for (const double below : {0.0, 0.01}) {
        const Scene scene = lit_by_surfaces(room_with_panel(below, 0.3));
        const Camera camera = room_camera();
        RenderSettings settings = soft_settings(24, 14, 4);
        settings.gbuffer = GBUFFER_FULL;
        Renderer renderer(scene, settings);
        renderer.render(camera, 0.0);
        ReferenceOptions options = reference_options(renderer, camera);
        const LitSurfaces lit = renderer.lit_surfaces();
        const std::vector<double> shadowed = shade_reference(lit, options).radiance.rgb;
        options.shadows = {};
        EXPECT_LT(picture_error(shadowed, shade_reference(lit, options).radiance.rgb), 1e-6);
    }
}

TEST(GlowingShadows, AreRefusedWhereLightsWithASizeAre) {
    const Scene scene = lit_by_surfaces(room_with_panel(0.0));
    RenderSettings settings = soft_settings();
    settings.shadows = Shadows::exact;
    expect_refused(scene, settings, "--shadows sampled");
    settings.shadows = Shadows::off;
    settings.shading = Shading::blinn_phong;
    expect_refused(scene, settings, "use pbr or lambert");
}

}  // namespace
}  // namespace kilolux
