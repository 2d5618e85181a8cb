// SPDX-License-Identifier: Apache-2.0
// Whole scenes through OpenGL and OpenCL: bad numbers, far origins, broken meshes, stale frames.
#include <algorithm>
#include <bit>
#include <cstring>

#include "host/certify/cases.h"
#include "host/certify/shot.h"
#include "host/render/light_source.h"
#include "host/render/renderer.h"
#include "host/scene/generated/scenes.h"

namespace kilolux {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

RenderSettings small_settings(const Gpu& gpu, int width, int height) {
    RenderSettings settings;
    settings.width = width;
    settings.height = height;
    settings.lights.count = 0;
    settings.kernels.lanes = gpu.info.lane_width;
    settings.device = gpu.info.name;
    return settings;
}

// --- 15 ---

SceneLight usual_light(Random& random, const Box& box) {
    SceneLight light;
    const glm::dvec3 t(random.unit(), random.unit(), random.unit());
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

// Each field with each value that makes a light unusable.
std::vector<BadLight> bad_lights(const Box& box) {
    Random random(15);
    std::vector<BadLight> out;
    const auto add = [&](const std::string& what, LightType type, const auto& spoil) {
        SceneLight light = usual_light(random, box);
        light.type = type;
        spoil(light);
        out.push_back({what, light});
    };
    for (const LightType type : {LightType::point, LightType::spot, LightType::directional}) {
        const bool local = type != LightType::directional;
        for (const float bad : {kNan, kInfinity, -kInfinity}) {
            const std::string value = std::to_string(bad);
            for (int c = 0; c < 3; ++c) {
                if (local)
                    add("position " + value, type, [&](auto& l) { l.position[c] = double{bad}; });
                add("intensity " + value, type, [&](auto& l) { l.intensity[c] = bad; });
                add("intensity " + value + ", no range", type, [&](auto& l) {
                    l.intensity[c] = bad;
                    l.range = 0.0f;
                });
                if (type != LightType::point) {
                    add("direction " + value, type, [&](auto& l) { l.direction[c] = double{bad}; });
                }
            }
            if (local) add("range " + value, type, [&](auto& l) { l.range = bad; });
            if (type != LightType::spot) continue;
            add("outer cone " + value, type, [&](auto& l) { l.outer_cone = bad; });
            add("inner cone " + value, type, [&](auto& l) { l.inner_cone = bad; });
        }
        for (int c = 0; c < 3; ++c)
            add("intensity -1", type, [&](auto& l) { l.intensity[c] = -1.0f; });
        if (type != LightType::point) add("direction 0", type, [](auto& l) { l.direction = {}; });
        if (local) add("position 1e30", type, [](auto& l) { l.position.x = 1e30; });
        if (local) add("range -1", type, [](auto& l) { l.range = -1.0f; });
    }
    return out;
}

template <typename T>
bool same_rows(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

bool same_bits(float a, float b) { return std::bit_cast<uint>(a) == std::bit_cast<uint>(b); }

Scene scene_with_lights(Random& random, int count) {
    Scene scene = make_generated_scene("plain");
    const Box box = bounds(scene);
    for (int i = 0; i < count; ++i) scene.lights.push_back(usual_light(random, box));
    return scene;
}

// One bad light in a thousand: its rows must be those of the other 999.
void check_rows(const Gpu& gpu, Findings& findings) {
    Random random(151);
    Scene scene = scene_with_lights(random, 999);
    FrameStats stats;
    RenderSettings none;
    none.lights.count = 0;
    const LightRows expected = LightSource(gpu, scene, none).at(0.0, {1, 2, 3}, stats);
    Worst wrong;
    for (const BadLight& bad : bad_lights(bounds(scene))) {
        scene.lights.insert(scene.lights.begin() + 500, bad.light);
        const LightRows rows = LightSource(gpu, scene, none).at(0.0, {1, 2, 3}, stats);
        scene.lights.erase(scene.lights.begin() + 500);
        const bool good = stats.lights_rejected == 1 && stats.lights_dropped == 0 &&
                          same_rows(rows.local, expected.local) &&
                          same_rows(rows.directional, expected.directional);
        wrong.see(good ? 0.0 : 1.0, [&] { return bad.what; });
    }
    findings.at_most("bad lights not rejected alone", wrong, 0.0);
    findings.tried("bad lights", wrong.checked, 60);
}

Frame render_first_camera(const Scene& scene, const RenderSettings& settings) {
    return Renderer(scene, settings).render(camera_of(scene.cameras.front()), 0.0);
}

// --- 24 ---

enum class Quad { usual, zero_normal, short_normal, long_normal, sliver, no_area };

// Eight by four quads before a camera at +z, with what is wrong about them by column.
Scene broken_scene(bool mended) {
    Mesh mesh;
    for (int i = 0; i < 32; ++i) {
        const auto kind = static_cast<Quad>(i % 8 % 6);
        const glm::vec3 p(static_cast<float>(i % 8), static_cast<float>(i / 8), 0.0f);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        const float width =
            mended || kind < Quad::sliver ? 1.0f : (kind == Quad::sliver ? 1e-6f : 0.0f);
        for (const glm::vec2 corner : {glm::vec2(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
            mesh.positions.push_back(p + glm::vec3(corner.x * width, corner.y, 0.0f));
            glm::vec3 normal(0.6f, 0.0f, 0.8f);
            if (kind == Quad::zero_normal) normal = glm::vec3(0.0f, 0.0f, mended ? 1.0f : 0.0f);
            if (kind == Quad::short_normal && !mended) normal *= 1e-20f;
            if (kind == Quad::long_normal && !mended) normal *= 1e20f;
            mesh.normals.push_back(normal);
        }
        for (const std::uint32_t c : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + c);
    }
    mesh.material = 0;
    Scene scene;
    scene.name = "broken";
    scene.meshes.push_back(mesh);
    scene.materials.emplace_back();
    scene.materials.back().metallic = 0.0f;
    scene.instances.push_back({0, glm::dmat4(1.0)});
    SceneLight light;
    light.position = {4, 2, 3};
    light.range = 20.0f;
    light.intensity = glm::vec3(10.0f);
    scene.lights.push_back(light);
    return scene;
}

Camera broken_camera() {
    Camera camera = look_at({4, 2, 10}, {4, 2, 0}, {0, 1, 0}, 1.0);
    camera.orthographic = true;
    camera.y_extent = 2.0;
    camera.z_far = 20.0;
    return camera;
}

// --- 19 ---

double to_multiple(double v) {
    constexpr double kStep = 0x1p-20;
    return std::round(v / kStep) * kStep;
}

// The plain scene with its places on multiples of 2^-20 m, which move by 2^20 or 1e6 m exactly.
Scene movable_scene() {
    Scene scene = make_generated_scene("plain");
    for (Instance& instance : scene.instances) {
        for (int c = 0; c < 3; ++c) {
            instance.world_from_object[3][c] = to_multiple(instance.world_from_object[3][c]);
        }
    }
    Random random(19);
    const Box box = bounds(scene);
    for (int i = 0; i < 60; ++i) {
        SceneLight light = usual_light(random, box);
        for (int c = 0; c < 3; ++c) light.position[c] = to_multiple(light.position[c]);
        scene.lights.push_back(light);
    }
    return scene;
}

Frame render_moved(Scene scene, const glm::dvec3& offset, const RenderSettings& settings) {
    for (Instance& instance : scene.instances) {
        instance.world_from_object[3] += glm::dvec4(offset, 0.0);
    }
    for (SceneLight& light : scene.lights) light.position += offset;
    Camera camera = camera_of(scene.cameras.front());
    for (int c = 0; c < 3; ++c) camera.position[c] = to_multiple(camera.position[c]);
    camera.position += offset;
    return Renderer(scene, settings).render(camera, 0.0);
}

Worst relative_difference(const Frame& a, const Frame& b) {
    double mean = 0.0;
    for (const float v : b.radiance) mean += v;
    const double floor = 0.01 * mean / static_cast<double>(b.radiance.size());
    Worst worst;
    for (std::size_t i = 0; i < a.radiance.size(); ++i) {
        worst.see(std::abs(double{a.radiance[i]} - b.radiance[i]) /
                      std::max(double{b.radiance[i]}, floor),
                  [&] { return "value " + std::to_string(i); });
    }
    return worst;
}

}  // namespace

void try_bad_numbers(const Gpu& gpu, Findings& findings) {
    check_rows(gpu, findings);
    // The picture of a scene with one bad light of each kind, and a mesh without a place.
    Random random(152);
    Scene scene = scene_with_lights(random, 200);
    const RenderSettings settings = small_settings(gpu, 64, 36);
    const Frame expected = render_first_camera(scene, settings);
    const std::vector<BadLight> bad = bad_lights(bounds(scene));
    for (const BadLight& b : bad) {
        if (b.light.type == LightType::point) scene.lights.push_back(b.light);
    }
    const std::size_t bad_count = scene.lights.size() - 200;
    scene.instances.push_back(scene.instances.front());
    scene.instances.back().world_from_object[3][1] = double{kNan};
    const Frame found = render_first_camera(scene, settings);
    findings.at_most("bits changed by bad lights and a bad matrix",
                     different_bits(found.radiance, expected.radiance), 0.0);
    findings.require(
        "all of them counted", found.stats.lights_rejected == bad_count,
        std::to_string(found.stats.lights_rejected) + " of " + std::to_string(bad_count));
}

void try_far_from_origin(const Gpu& gpu, Findings& findings) {
    const Scene scene = movable_scene();
    const RenderSettings settings = small_settings(gpu, 80, 45);
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
    RenderSettings settings = small_settings(gpu, 64, 32);
    settings.want.aovs = {"normal", "depth"};
    const Frame found = Renderer(broken, settings).render(broken_camera(), 0.0);
    const Frame expected = Renderer(mended, settings).render(broken_camera(), 0.0);
    std::uint64_t not_finite = 0;
    for (const float v : found.radiance) not_finite += std::isfinite(v) && v >= 0.0f ? 0 : 1;
    for (const float v : found.aovs[0].values) not_finite += std::isfinite(v) ? 0 : 1;
    findings.none("NaN, Inf or negative", not_finite, found.radiance.size());
    // What is drawn of the broken quads, all but the slivers, looks as the mended ones do: zero
    // normals became +z of the view, which theirs is.
    std::uint64_t drawn = 0;
    std::uint64_t different = 0;
    for (std::size_t i = 0; i < found.aovs[1].values.size(); ++i) {
        if (found.aovs[1].values[i] == 0.0f) continue;
        ++drawn;
        const float* pixel = &found.radiance[3 * i];
        different += std::equal(pixel, pixel + 3, &expected.radiance[3 * i], same_bits) ? 0 : 1;
    }
    findings.none("pixels unlike those of sound normals", different, drawn);
    findings.tried("drawn pixels", drawn, 64 * 32 / 2);
    findings.require("zero normals counted", found.stats.zero_normals == 32,
                     std::to_string(found.stats.zero_normals) + " counted");
}

void try_alternating_frames(const Gpu& gpu, Findings& findings) {
    Random random(30);
    const Scene scene = scene_with_lights(random, 100);
    Camera cameras[2] = {camera_of(scene.cameras.front()), camera_of(scene.cameras.front())};
    cameras[1].position += glm::dvec3(0.4, 0.1, -0.3);
    Renderer renderer(scene, small_settings(gpu, 96, 54));
    const Frame first[2] = {renderer.render(cameras[0], 0.0), renderer.render(cameras[1], 0.0)};
    findings.require("the two frames differ",
                     different_bits(first[0].radiance, first[1].radiance).value > 1000);
    for (int frame = 0; frame < 20; ++frame) {
        const Frame found = renderer.render(cameras[frame % 2], 0.0);
        findings.at_most("bits of frame n that are not its own",
                         different_bits(found.radiance, first[frame % 2].radiance), 0.0);
    }
}

}  // namespace kilolux
