// SPDX-License-Identifier: Apache-2.0
// Whole scenes through OpenGL and OpenCL: bad numbers, far origins, degenerate meshes, stale
// frames.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <span>

#include "host/certify/cases.h"
#include "host/certify/scene_case.h"
#include "host/render/lights/light_source.h"
#include "host/render/renderer.h"
#include "host/scene/generated/scenes.h"
#include "host/scene/lights/light_kinds.h"

namespace kilolux {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Case 15, bad-numbers.

SceneLight usual_light(Random& random, const Box& box) {
    SceneLight light;
    const glm::dvec3 t{random.unit(), random.unit(), random.unit()};
    light.position = box.min + t * box.size();
    light.intensity = {random.unit(), random.unit(), 1.0};
    light.range = static_cast<float>(random.uniform(0.1, 0.3) * glm::length(box.size()));
    light.direction = {0, -1, 0};
    light.inner_cone = 0.2f;
    light.outer_cone = 0.6f;
    return light;
}

struct BadLight {
    std::string what;
    SceneLight light;
};

// Lights with one invalid value: each field, each kind of value.
std::vector<BadLight> bad_lights(const Box& box) {
    Random random(15);
    std::vector<BadLight> out;
    const auto add = [&](const std::string& what, LightType type, const auto& spoil) {
        SceneLight light = usual_light(random, box);
        light.type = type;
        light.width = light.height = light.radius = 0.25f;
        spoil(light);
        out.push_back({what, light});
    };
    for (const LightKind& kind : kLightKinds) {
        const LightType type = kind.type;
        const bool local = kind.is_placed, aimed = kind.is_aimed;
        for (const float bad : {kNan, kInfinity, -kInfinity}) {
            const auto spoil = [&](bool exists, const char* field, const auto& change) {
                if (exists) add(fmt::format("{} {:f}", field, bad), type, change);
            };
            for (int c = 0; c < 3; ++c) {
                spoil(local, "position", [&](auto& l) { l.position[c] = double{bad}; });
                spoil(true, "intensity", [&](auto& l) { l.intensity[c] = bad; });
                spoil(true, "without a range, intensity", [&](auto& l) {
                    l.intensity[c] = bad;
                    l.range = 0.0f;
                });
                spoil(aimed, "direction", [&](auto& l) { l.direction[c] = double{bad}; });
            }
            for (const LightNumber& number : kLightNumbers) {
                spoil(kind.*number.has, number.name, [&](auto& l) { l.*number.member = bad; });
            }
        }
        for (int c = 0; c < 3; ++c)
            add("intensity -1", type, [&](auto& l) { l.intensity[c] = -1.0f; });
        if (aimed) add("direction 0", type, [](auto& l) { l.direction = {}; });
        if (local) add("position 1e30", type, [](auto& l) { l.position.x = 1e30; });
        for (const LightNumber& number : kLightNumbers) {
            if (!(kind.*number.has) || !number.is_positive) continue;
            add(fmt::format("{} -1", number.name), type,
                [&](auto& l) { l.*number.member = -1.0f; });
        }
    }
    return out;
}

template <typename T>
bool same_rows(const std::vector<T>& a, const std::vector<T>& b) {
    return std::ranges::equal(std::as_bytes(std::span(a)), std::as_bytes(std::span(b)));
}

bool same_bits(float a, float b) { return std::bit_cast<uint>(a) == std::bit_cast<uint>(b); }

Scene scene_with_lights(Random& random, int count) {
    Scene scene = make_generated_scene("plain");
    const Box box = bounds(scene);
    for (int i = 0; i < count; ++i) scene.lights.push_back(usual_light(random, box));
    return scene;
}

// The scene's lights as the device has them.
LightRows device_rows(const Gpu& gpu, const Scene& scene, FrameStats& stats) {
    Camera camera;
    camera.position = {1.0, 2.0, 3.0};
    RenderSettings none;
    none.lights.count = 0;
    StageTimer untimed;
    LightSource source(gpu, default_tuning(gpu.info), scene, none);
    source.update(0.0, camera, stats);
    const LightInput input = source.input(camera.position, false, untimed);
    LightRows out;
    out.local = download(gpu, input.lights, input.count);
    out.directional = download(gpu, input.directional, input.directional_count);
    return out;
}

// With one bad light in a thousand, the rows must be those of the other 999.
void check_rows(const Gpu& gpu, Findings& findings) {
    Random random(151);
    Scene scene = scene_with_lights(random, 999);
    FrameStats stats;
    const LightRows expected = device_rows(gpu, scene, stats);
    Worst wrong;
    for (const BadLight& bad : bad_lights(bounds(scene))) {
        scene.lights.insert(scene.lights.begin() + 500, bad.light);
        const LightRows rows = device_rows(gpu, scene, stats);
        scene.lights.erase(scene.lights.begin() + 500);
        const bool good = stats.lights_rejected == 1 && same_rows(rows.local, expected.local) &&
                          same_rows(rows.directional, expected.directional);
        wrong.add(good ? 0.0 : 1.0, [&] { return bad.what; });
    }
    findings.at_most("bad lights not rejected alone", wrong, 0.0);
    findings.at_least("bad lights", wrong.checked, 60);
}

Frame render_first_camera(const Scene& scene, const RenderSettings& settings) {
    return Renderer(scene, settings).render(camera_of(scene.cameras.front()), 0.0);
}

// Case 24, degenerate-surfaces.

enum class Quad { usual, zero_normal, short_normal, long_normal, sliver, no_area };

// Eight by four quads; the column says what is wrong with a quad.
Scene broken_scene(bool mended) {
    Mesh mesh;
    for (int i = 0; i < 32; ++i) {
        const auto kind = static_cast<Quad>(i % 8 % 6);
        const bool broken = !mended;
        float width = 1.0f;
        if (kind == Quad::sliver && broken) width = 1e-6f;
        if (kind == Quad::no_area && broken) width = 0.0f;
        glm::vec3 normal(0.6f, 0.0f, 0.8f);
        if (kind == Quad::zero_normal) normal = glm::vec3(0.0f, 0.0f, broken ? 0.0f : 1.0f);
        if (kind == Quad::short_normal && broken) normal *= 1e-20f;
        if (kind == Quad::long_normal && broken) normal *= 1e20f;
        add_quad(mesh, {i % 8, i / 8}, width, normal);
    }
    Scene scene = quad_scene(mesh);
    scene.materials.back().metallic = 0.0f;
    SceneLight light;
    light.position = {4, 2, 3};
    light.range = 20.0f;
    light.intensity = glm::vec3(10.0f);
    scene.lights.push_back(light);
    return scene;
}

// Case 19, far-from-origin.

template <typename Vector>
Vector to_multiple(const Vector& v) {
    return glm::round(v * 0x1p20) * 0x1p-20;
}

// The plain scene with positions on multiples of 2^-20 m, so that moves by 2^20 and 1e6 m are
// exact.
Scene movable_scene() {
    Scene scene = make_generated_scene("plain");
    for (Instance& instance : scene.instances) {
        instance.world_from_object[3] = to_multiple(instance.world_from_object[3]);
    }
    Random random(19);
    const Box box = bounds(scene);
    for (int i = 0; i < 60; ++i) {
        scene.lights.push_back(usual_light(random, box));
        scene.lights.back().position = to_multiple(scene.lights.back().position);
    }
    return scene;
}

Frame render_moved(Scene scene, const glm::dvec3& offset, const RenderSettings& settings) {
    for (Instance& instance : scene.instances) {
        instance.world_from_object[3] += glm::dvec4(offset, 0.0);
    }
    for (SceneLight& light : scene.lights) light.position += offset;
    Camera camera = camera_of(scene.cameras.front());
    camera.position = to_multiple(camera.position) + offset;
    return Renderer(scene, settings).render(camera, 0.0);
}

Worst relative_difference(const Frame& a, const Frame& b) {
    double mean = 0.0;
    for (const float v : b.radiance) mean += v;
    const double floor = 0.01 * mean / static_cast<double>(b.radiance.size());
    Worst worst;
    for (std::size_t i = 0; i < a.radiance.size(); ++i) {
        worst.add(std::abs(double{a.radiance[i]} - b.radiance[i]) /
                      std::max(double{b.radiance[i]}, floor),
                  [&] { return fmt::format("value {}", i); });
    }
    return worst;
}

}  // namespace

void try_bad_numbers(const Gpu& gpu, Findings& findings) {
    check_rows(gpu, findings);
    // The picture of a scene with every bad light, and an instance with a NaN matrix.
    Random random(152);
    Scene scene = scene_with_lights(random, 200);
    const RenderSettings settings = scene_settings(gpu, 64, 36);
    const Frame expected = render_first_camera(scene, settings);
    const std::vector<BadLight> bad = bad_lights(bounds(scene));
    for (const BadLight& b : bad) {
        if (b.light.type == LightType::point) scene.lights.push_back(b.light);
    }
    const std::size_t bad_count = scene.lights.size() - 200;
    scene.instances.push_back(scene.instances.front());
    scene.instances.back().world_from_object[3][1] = double{kNan};
    const Frame found = render_first_camera(scene, settings);
    check_same_bits(findings, "bits changed by bad lights and a bad matrix", found.radiance,
                    expected.radiance);
    findings.require("all of them counted", found.stats.lights_rejected == bad_count,
                     fmt::format("{} of {}", found.stats.lights_rejected, bad_count));
}

void try_far_from_origin(const Gpu& gpu, Findings& findings) {
    const Scene scene = movable_scene();
    const RenderSettings settings = scene_settings(gpu, 80, 45);
    const Frame expected = render_moved(scene, glm::dvec3(0.0), settings);
    const glm::dvec3 power(0x1p20, -0x1p20, 0x1p20);
    findings.at_most("moved by 2^20 m: relative difference",
                     relative_difference(render_moved(scene, power, settings), expected), 3e-6);
    findings.at_most("moved by 1e6 m",
                     relative_difference(render_moved(scene, glm::dvec3(1e6), settings), expected),
                     3e-6);
}

void try_degenerate_surfaces(const Gpu& gpu, Findings& findings) {
    const Scene broken = broken_scene(false);
    const Scene mended = broken_scene(true);
    RenderSettings settings = scene_settings(gpu, 64, 32);
    settings.want.aovs = {"normal", "depth"};
    const Frame found = Renderer(broken, settings).render(quad_camera(8, 4), 0.0);
    const Frame expected = Renderer(mended, settings).render(quad_camera(8, 4), 0.0);
    std::uint64_t not_finite = count_invalid(found.radiance);
    for (const float v : found.aovs[0].values) not_finite += std::isfinite(v) ? 0 : 1;
    findings.none("NaN, Inf or negative", not_finite, found.radiance.size());
    // The surface pixels of broken quads equal those of mended ones, whose zero normals are +z.
    std::uint64_t drawn = 0;
    std::uint64_t different = 0;
    for (std::size_t i = 0; i < found.aovs[1].values.size(); ++i) {
        if (found.aovs[1].values[i] == 0.0f) continue;
        ++drawn;
        const float* pixel = &found.radiance[3 * i];
        different += std::equal(pixel, pixel + 3, &expected.radiance[3 * i], same_bits) ? 0 : 1;
    }
    findings.none("pixels unlike those of sound normals", different, drawn);
    findings.at_least("surface pixels", drawn, 64 * 32 / 2);
    findings.require("zero normals counted", found.stats.zero_normals == 32,
                     fmt::format("{} counted", found.stats.zero_normals));
}

void try_alternating_frames(const Gpu& gpu, Findings& findings) {
    Random random(30);
    const Scene scene = scene_with_lights(random, 100);
    Camera cameras[2] = {camera_of(scene.cameras.front()), camera_of(scene.cameras.front())};
    cameras[1].position += glm::dvec3(0.4, 0.1, -0.3);
    Renderer renderer(scene, scene_settings(gpu, 96, 54));
    const Frame first[2] = {renderer.render(cameras[0], 0.0), renderer.render(cameras[1], 0.0)};
    findings.require("the two frames differ",
                     different_bits(first[0].radiance, first[1].radiance).value > 1000);
    for (int frame = 0; frame < 20; ++frame) {
        const Frame found = renderer.render(cameras[frame % 2], 0.0);
        check_same_bits(findings, "bits of frame n that are not its own", found.radiance,
                        first[frame % 2].radiance);
    }
}

}  // namespace kilolux
