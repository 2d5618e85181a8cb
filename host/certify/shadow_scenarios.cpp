// SPDX-License-Identifier: Apache-2.0
#include "host/certify/shadow_scenarios.h"

#include <cmath>
#include <numbers>
#include <random>

#include "host/measure/reference/decoded_samples.h"
#include "host/measure/reference/shadow_caster.h"
#include "host/render/renderer.h"
#include "host/scene/generated/mesh_builder.h"

namespace kilolux {
namespace {

// A sphere whose quads share corners.
Mesh sphere_mesh(double radius, int rings) {
    Mesh mesh;
    const int columns = 2 * rings;
    for (int i = 0; i <= rings; ++i) {
        for (int j = 0; j < columns; ++j) {
            const double polar = std::numbers::pi * i / rings;
            const double around = 2.0 * std::numbers::pi * j / columns;
            const glm::dvec3 n(std::sin(polar) * std::cos(around), std::cos(polar),
                               std::sin(polar) * std::sin(around));
            mesh.positions.emplace_back(radius * n);
            mesh.normals.emplace_back(n);
        }
    }
    for (int i = 0; i < rings; ++i) {
        for (int j = 0; j < columns; ++j) {
            const auto a = static_cast<std::uint32_t>(i * columns + j);
            const auto b = static_cast<std::uint32_t>(i * columns + (j + 1) % columns);
            const auto down = static_cast<std::uint32_t>(columns);
            mesh.indices.insert(mesh.indices.end(), {a, b, a + down, b, b + down, a + down});
        }
    }
    mesh.material = 0;
    return mesh;
}

// Whether a shadow's edge passes `distance` [m] from the point.
bool is_edge_at(const ShadowCaster& caster, const ShadowPoint& point, const glm::dvec3& light,
                double distance) {
    const bool seen = caster.sees(point, light);
    for (int i = 0; i < 26; ++i) {
        const int code = i < 13 ? i : i + 1;
        const glm::dvec3 way(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
        ShadowPoint moved = point;
        moved.position += distance * way;
        if (caster.sees(moved, light) != seen) return true;
    }
    return false;
}

// Whether a shadow's edge passes within `distance` [m] of the point, of a thin shadow, too.
bool is_near_edge(const ShadowCaster& caster, const ShadowPoint& point, const glm::dvec3& light,
                  double distance) {
    for (const double share : {1.0, 0x1p-3, 0x1p-6, 0x1p-9}) {
        if (is_edge_at(caster, point, light, share * distance)) return true;
    }
    return false;
}

}  // namespace

SceneLight lamp(const glm::dvec3& position, float range) {
    SceneLight light;
    light.position = position;
    light.intensity = {50.0f, 50.0f, 50.0f};
    light.range = range;
    return light;
}

void add_box(Scene& scene, const glm::dvec3& size, const glm::dvec3& center, double turn_rad) {
    MeshBuilder builder;
    builder.box(-0.5 * size, 0.5 * size);
    Mesh mesh = builder.build("box", 0, 1.0, false);
    glm::dmat4 place(1.0);
    place[0] = {std::cos(turn_rad), 0.0, std::sin(turn_rad), 0.0};
    place[2] = {-std::sin(turn_rad), 0.0, std::cos(turn_rad), 0.0};
    place[3] = glm::dvec4(center, 1.0);
    scene.instances.push_back({static_cast<int>(scene.meshes.size()), place});
    scene.meshes.push_back(std::move(mesh));
}

Scene shadow_stage() {
    Scene scene;
    scene.name = "stage";
    Material material;
    material.metallic = 0.0f;
    material.double_sided = true;
    material.base_color = {0.8f, 0.8f, 0.8f, 1.0f};
    scene.materials.push_back(material);
    return scene;
}

ShadowScenario columns_scenario() {
    Scene scene = shadow_stage();
    add_box(scene, {30.0, 0.5, 30.0}, {0.0, -0.25, 0.0});
    for (int i = 0; i < 7; ++i) {
        add_box(scene, {0.6, 4.0, 0.6}, {2.0 * i - 6.0, 2.0, 0.0}, 0.15 * i);
    }
    scene.lights.push_back(lamp({0.5, 3.0, -5.0}));
    return {"columns", scene, look_at({1.0, 8.0, 14.0}, {0.0, 0.5, 2.0}, {0, 1, 0}, 0.8)};
}

ShadowScenario thin_wall_scenario() {
    Scene scene = shadow_stage();
    add_box(scene, {20.0, 0.5, 20.0}, {0.0, -0.25, 0.0});
    add_box(scene, {20.0, 10.0, 0.001}, {0.0, 5.0, 0.0});
    scene.lights.push_back(lamp({0.3, 1.0, -0.25}));
    return {"thin wall", scene, look_at({0.0, 4.0, 9.0}, {0.0, 0.0, 2.0}, {0, 1, 0}, 0.9)};
}

ShadowScenario grazing_scenario() {
    Scene scene = shadow_stage();
    Mesh floor;
    constexpr int kSide = 40;
    for (int i = 0; i <= kSide; ++i) {
        for (int j = 0; j <= kSide; ++j) {
            // Uneven, so that no coordinate is round.
            floor.positions.emplace_back(0.37 * i - 7.4, 0.1, 0.41 * j - 8.2);
            floor.normals.emplace_back(0.0f, 1.0f, 0.0f);
        }
    }
    for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
            const auto a = static_cast<std::uint32_t>(i * (kSide + 1) + j);
            const auto b = a + kSide + 1;
            floor.indices.insert(floor.indices.end(), {a, a + 1, b, b, a + 1, b + 1});
        }
    }
    floor.material = 0;
    scene.meshes.push_back(floor);
    // Turned, so that its corners round.
    glm::dmat4 place(1.0);
    place[0] = {std::cos(0.3), std::sin(0.3), 0.0, 0.0};
    place[1] = {-std::sin(0.3), std::cos(0.3), 0.0, 0.0};
    scene.instances.push_back({0, place});
    const glm::dvec3 above = glm::dvec3(place * glm::dvec4(0.3, 0.101, 0.2, 1.0));
    scene.lights.push_back(lamp(above));
    return {"grazing", scene, look_at({-3.0, 9.0, 9.0}, {0.0, 0.0, 0.0}, {0, 1, 0}, 0.9)};
}

ShadowScenario spheres_scenario() {
    Scene scene = shadow_stage();
    add_box(scene, {20.0, 0.5, 20.0}, {0.0, -0.25, 0.0});
    for (int i = 0; i < 3; ++i) {
        glm::dmat4 place(1.0);
        place[3] = {3.0 * i - 3.0, 1.1, 0.5 * i, 1.0};
        scene.instances.push_back({static_cast<int>(scene.meshes.size()), place});
        scene.meshes.push_back(sphere_mesh(1.0, 6 << (2 * i)));
    }
    scene.lights.push_back(lamp({-1.0, 4.0, -3.0}));
    return {"spheres", scene, look_at({1.0, 5.0, 9.0}, {0.0, 0.8, 0.0}, {0, 1, 0}, 0.8)};
}

ShadowScenario sheet_scenario() {
    Scene scene = shadow_stage();
    Mesh sheet;
    // Made of blunt triangles, whose planes float32 knows least.
    constexpr std::uint32_t kStrips = 200;
    for (std::uint32_t i = 0; i <= kStrips; ++i) {
        const float z = -5.0f + 0.05f * static_cast<float>(i);
        sheet.positions.insert(sheet.positions.end(), {{-5, 0, z}, {0, 0, z}, {5, 0, z}});
        if (i == kStrips) break;
        const std::uint32_t a = 3 * i;
        sheet.indices.insert(sheet.indices.end(),
                             {a, a + 4, a + 2, a, a + 3, a + 4, a + 2, a + 4, a + 5});
    }
    sheet.normals.assign(sheet.positions.size(), glm::normalize(glm::vec3(2, 1, 0)));
    sheet.material = 0;
    scene.meshes.push_back(sheet);
    scene.instances.push_back({0, glm::dmat4(1.0)});
    scene.lights.push_back(lamp({9.0, -0.5, 0.0}));
    return {"sheet", scene, look_at({0.0, 8.0, 6.0}, {0.0, 0.0, 0.0}, {0, 1, 0}, 0.9)};
}

ShadowScenario needles_scenario() {
    constexpr int kPointing = 1500;  // an edge of each points at the light
    constexpr int kLying = 30000;    // of 0.1 mm by 0.6 m, whose ends are sharp
    const glm::dvec3 light(0.3, 4.1, -0.2);
    Scene scene = shadow_stage();
    add_box(scene, {6.0, 0.5, 6.0}, {0.0, -0.25, 0.0});
    std::mt19937 random(3);  // its numbers are the same everywhere
    const auto unit = [&] { return static_cast<double>(random()) * 0x1p-32; };
    const auto around = [&](double radius) {
        const double angle = 2.0 * std::numbers::pi * unit();
        return radius * glm::dvec3(std::cos(angle), 0.0, std::sin(angle));
    };
    Mesh needles;
    const auto add = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        for (const glm::dvec3& p : {a, b, c}) {
            needles.indices.push_back(static_cast<std::uint32_t>(needles.positions.size()));
            needles.positions.emplace_back(p);
        }
    };
    for (int i = 0; i < kPointing; ++i) {
        const glm::dvec3 down = glm::dvec3(0.0, -1.0, 0.0) + around(0.25 * std::sqrt(unit()));
        const glm::dvec3 end = light + 3.0 * down + around(3e-4);
        const glm::dvec3 side = end + around(0.02);
        add(light + down, end, side);
    }
    for (int i = 0; i < kLying; ++i) {
        const glm::dvec3 base = around(2.5 * std::sqrt(unit())) + glm::dvec3(0.0, 1.0, 0.0);
        const glm::dvec3 along = around(0.6);
        add(base, base + 1e-4 * glm::dvec3(along.z, 0.0, -along.x), base + along);
    }
    needles.normals.assign(needles.positions.size(), {0, 0, 1});
    needles.material = 0;
    scene.instances.push_back({static_cast<int>(scene.meshes.size()), glm::dmat4(1.0)});
    scene.meshes.push_back(needles);
    scene.lights.push_back(lamp(light));
    return {"needles", scene, look_at({0.3, 2.2, 2.6}, {0.3, 0.2, 0.5}, {0, 1, 0}, 0.8)};
}

ShadowScenario moved(ShadowScenario from, const glm::dvec3& by) {
    for (Instance& instance : from.scene.instances) {
        instance.world_from_object[3] += glm::dvec4(by, 0.0);
    }
    for (SceneLight& light : from.scene.lights) light.position += by;
    from.camera.position += by;
    from.name += " far away";
    return from;
}

ShadowAgreement compare_shadows(const ShadowScenario& scenario, RenderSettings settings) {
    settings.shadows = Shadows::exact;
    settings.want.view = ViewKind::shadows;
    settings.want.aovs = {"visibility"};
    Renderer renderer(scenario.scene, settings);
    const Frame frame = renderer.render(scenario.camera, 0.0);
    const ShadowCaster caster(scenario.scene, scenario.camera);
    const glm::dvec3 world_light = scenario.scene.lights.front().position;
    const glm::dmat3 view_from_world = glm::transpose(scenario.camera.world_from_view);
    const glm::dvec3 light = view_from_world * (world_light - scenario.camera.position);
    const SurfaceSamples surfaces = surface_samples(renderer.lit_surfaces().surfaces);
    ShadowAgreement out;
    for (std::size_t i = 0; i < surfaces.pixels.size(); ++i) {
        const SurfaceSample& surface = surfaces.pixels[i];
        if (surface.kind == SurfaceKind::background) continue;
        const glm::dvec3 to_light = light - surface.position;
        if (!(glm::dot(surface.normal, to_light) > 0.0)) continue;
        const auto point = caster.point_at(surface.position);
        if (!point) continue;
        ++out.pixels;
        const bool seen = caster.sees(*point, light);
        const bool device = frame.aovs[0].values[i] > 0.5f;
        out.hidden += seen ? 0 : 1;
        if (seen == device) continue;
        ++out.differ;
        // 2^-17 of the scene's and the light's distances, as the kernels state.
        const double stated = 0x1p-15 * (glm::length(to_light) + 15.0);
        out.unfounded += is_near_edge(caster, *point, light, stated) ? 0 : 1;
    }
    return out;
}

}  // namespace kilolux
