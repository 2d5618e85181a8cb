// SPDX-License-Identifier: Apache-2.0
#include "host/scene/export/nodes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/scene/export/materials.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_shape.h"
#include "host/scene/lights/light_side.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

Json matrix_json(const glm::dmat4& m) { return std::vector<double>(&m[0][0], &m[0][0] + 16); }

glm::dmat4 with_axes(const glm::dmat3& axes, const glm::dvec4& origin) {
    glm::dmat4 out(axes);
    out[3] = origin;
    return out;
}

// Turns columns p and q of `a` about each other until they are orthogonal, and `v` with them
// (one-sided Jacobi: Demmel and Veselic 1992, section 4).
void make_orthogonal(glm::dmat3& a, glm::dmat3& v, glm::length_t p, glm::length_t q) {
    const double along = glm::dot(a[p], a[q]);
    if (along == 0.0) return;
    const double zeta = (glm::dot(a[q], a[q]) - glm::dot(a[p], a[p])) / (2.0 * along);
    const double t = (zeta >= 0.0 ? 1.0 : -1.0) / (std::abs(zeta) + std::hypot(1.0, zeta));
    const double c = 1.0 / std::hypot(1.0, t);
    const double s = c * t;
    for (glm::dmat3* m : {&a, &v}) {
        const glm::dvec3 kept = (*m)[p];
        (*m)[p] = c * kept - s * (*m)[q];
        (*m)[q] = s * kept + c * (*m)[q];
    }
}

// Whether a node can hold the matrix: glTF asks for translation, rotation and scale.
bool is_orthogonal(const glm::dmat3& m) {
    constexpr double kCosine = 1e-6;  // readers that decompose the matrix do not notice this
    for (const auto& [p, q] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{2, 0}}) {
        const double lengths = glm::length(m[p]) * glm::length(m[q]);
        if (std::abs(glm::dot(m[p], m[q])) > kCosine * lengths) return false;
    }
    return true;
}

// Adds a node with a transform; returns the index of the node that belongs to the scene. A matrix
// that shears is U V^T with orthogonal columns in U and a rotation V: a parent and a child.
int add_placed(Json& nodes, const glm::dmat4& world_from_node, Json node) {
    glm::dmat3 axes(world_from_node);
    if (is_orthogonal(axes)) {
        if (world_from_node != glm::dmat4(1.0)) node["matrix"] = matrix_json(world_from_node);
        nodes.push_back(std::move(node));
        return static_cast<int>(nodes.size()) - 1;
    }
    constexpr int kSweeps = 30;  // converges quadratically; 3 columns take about 6
    glm::dmat3 rotation(1.0);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        make_orthogonal(axes, rotation, 0, 1);
        make_orthogonal(axes, rotation, 1, 2);
        make_orthogonal(axes, rotation, 0, 2);
    }
    const glm::dvec4 origin(0.0, 0.0, 0.0, 1.0);
    node["matrix"] = matrix_json(with_axes(glm::transpose(rotation), origin));
    nodes.push_back(std::move(node));
    const int child = static_cast<int>(nodes.size()) - 1;
    nodes.push_back(
        {{"children", {child}}, {"matrix", matrix_json(with_axes(axes, world_from_node[3]))}});
    return child + 1;
}

// A file need not say a range: 0 means that it does not, infinity that there is none.
SceneLight with_range(SceneLight light) {
    if (light.range <= 0.0f || std::isinf(light.range)) light.range = 1.0f;
    return light;
}

bool is_usable(const SceneLight& light) {
    const glm::dvec3 intensity(light.intensity);
    const LightKind& kind = kind_of(light);
    const bool aimed = (!kind.is_aimed && light.profile < 0) ||
                       (is_finite(light.direction) && glm::length(light.direction) > 0.0);
    return is_finite(intensity) && std::min({intensity.x, intensity.y, intensity.z}) >= 0.0 &&
           is_finite(light.position) && aimed && has_good_numbers(with_range(light));
}

// The light with angles as KHR_lights_punctual allows them: inner < outer <= 90 degrees.
SceneLight with_angles(SceneLight light) {
    constexpr double kRight = std::numbers::pi / 2;
    light.outer_cone = std::min(light.outer_cone, std::nextafter(static_cast<float>(kRight), 0.0f));
    light.inner_cone = std::clamp(light.inner_cone, 0.0f, std::nextafter(light.outer_cone, 0.0f));
    return light;
}

double brightest(const SceneLight& light) {
    return std::max({light.intensity.x, light.intensity.y, light.intensity.z});
}

// The colour relative to the brightest channel; left out where it is white.
void add_color(Json& out, const SceneLight& light) {
    const glm::dvec3 color(light.intensity);
    const double most = brightest(light);
    if (most > 0.0 && color != glm::dvec3(most)) {
        out["color"] = {color.x / most, color.y / most, color.z / most};
    }
}

Json light_json(const SceneLight& light, std::size_t extension) {
    const LightKind& kind = kind_of(light);
    const double unit = kind.is_flat ? seen_area(light) : 1.0;  // candela become nits
    Json out{{"type", kind.name_in_file}, {"intensity", brightest(light) / unit}};
    add_color(out, light);
    const SceneLight allowed = with_angles(light);
    for (const LightNumber& number : kLightNumbers) {
        const float value = allowed.*number.member;
        const std::string_view path = number.paths[extension];
        if (kind.*number.has && !path.empty() && value > 0.0f && std::isfinite(value)) {
            at_path(out, path) = value;
        }
    }
    if (kind.is_flat && light.width != light.height) {
        at_path(out, kind.aspect_in_file) = double{light.width} / double{light.height};
    }
    if (kind.is_flat && light.two_sided) at_path(out, kTwoSided) = true;
    return out;
}

// Lights travel along their node's -Z, and X is their side.
glm::dmat3 axes_of(const SceneLight& light) {
    const glm::dvec3 z = -glm::normalize(light.direction);
    const glm::dvec3 x = perpendicular_side(-z, light.side);
    return {x, glm::cross(z, x), z};
}

// A light's node with what the scene says of it.
Json light_node(const SceneLight& light, const Scene& scene) {
    Json node = Json::object();
    if (light.node < 0) return node;
    const LightNode& from = scene.light_nodes[static_cast<std::size_t>(light.node)];
    if (!from.name.empty()) node["name"] = from.name;
    if (!from.group.empty()) at_path(node, kExtrasGroup) = from.group;
    return node;
}

void add_light(ExportedNodes& out, const SceneLight& light, const Scene& scene) {
    const std::string extension(kind_of(light).extension);
    const auto* const place = std::ranges::find(kLightExtensions, kind_of(light).extension);
    Json& lights = out.lights[extension]["lights"];
    Json node = light_node(light, scene);
    node["extensions"][extension]["light"] = lights.size();
    lights.push_back(light_json(light, static_cast<std::size_t>(place - kLightExtensions.begin())));
    if (!kind_of(light).is_aimed) {
        node["translation"] = {light.position.x, light.position.y, light.position.z};
    } else {
        node["matrix"] = matrix_json(with_axes(axes_of(light), glm::dvec4(light.position, 1.0)));
    }
    out.roots.push_back(out.nodes.size());
    out.nodes.push_back(std::move(node));
}

// EXT_lights_ies: the web's vertical angle 0 is along the node's -Z, its horizontal one along +X.
void add_profile_light(ExportedNodes& out, const SceneLight& light, const Scene& scene) {
    const SceneProfile& profile = scene.aimed_profiles[static_cast<std::size_t>(light.profile)];
    Json use{{"light", profile.web},
             {"multiplier", brightest(light) / scene.webs[profile.web].peak}};
    add_color(use, light);
    glm::dmat3 axes = axes_of(light);
    if (profile.mirrored) axes[1] = -axes[1];
    Json node = light_node(light, scene);
    node["matrix"] = matrix_json(with_axes(axes, glm::dvec4(light.position, 1.0)));
    node["extensions"]["EXT_lights_ies"] = std::move(use);
    out.roots.push_back(out.nodes.size());
    out.nodes.push_back(std::move(node));
}

Json orthographic_json(const SceneCamera& camera, double shift) {
    const double aspect = camera.aspect > 0.0 ? camera.aspect : 1.0;
    return {{"xmag", camera.y_extent * aspect},
            {"ymag", camera.y_extent},
            {"znear", camera.z_near + shift},
            {"zfar", camera.z_far + shift}};
}

Json perspective_json(const SceneCamera& camera) {
    Json out{{"yfov", camera.y_fov}, {"znear", camera.z_near}};
    if (camera.aspect > 0.0) out["aspectRatio"] = camera.aspect;
    if (std::isfinite(camera.z_far)) out["zfar"] = camera.z_far;
    return out;
}

void add_camera(ExportedNodes& out, const SceneCamera& camera) {
    // glTF's depths are not negative: a parallel camera with a negative z_near is moved back.
    const double shift = camera.orthographic ? std::max(-camera.z_near, 0.0) : 0.0;
    const char* type = camera.orthographic ? "orthographic" : "perspective";
    Json entry{{"type", type}};
    if (!camera.name.empty()) entry["name"] = camera.name;
    entry[type] = camera.orthographic ? orthographic_json(camera, shift) : perspective_json(camera);
    glm::dmat4 m = camera.world_from_camera;
    if (shift > 0.0) {
        m[3] += glm::dvec4(glm::normalize(glm::dvec3(m[2])) * shift, 0.0);
    }
    out.roots.push_back(add_placed(out.nodes, m, {{"camera", out.cameras.size()}}));
    out.cameras.push_back(std::move(entry));
}

}  // namespace

ExportedNodes export_nodes(const Scene& scene, const std::vector<int>& mesh_of) {
    ExportedNodes out;
    for (const SceneCamera& camera : scene.cameras) add_camera(out, camera);
    for (const Instance& instance : scene.instances) {
        const int mesh = mesh_of[static_cast<std::size_t>(instance.mesh)];
        const bool is_point = glm::dmat3(instance.world_from_object) == glm::dmat3(0.0);
        if (mesh < 0 || is_point) continue;
        out.roots.push_back(add_placed(out.nodes, instance.world_from_object, {{"mesh", mesh}}));
    }
    for (const SceneLight& light : scene.lights) {
        if (light.of_surface) continue;
        if (kind_of(light).extension.empty() || !is_usable(light)) {  // files have no triangles
            ++out.unusable_lights;
            continue;
        }
        ++out.usable_lights;
        if (light.profile >= 0) {
            add_profile_light(out, light, scene);
        } else {
            add_light(out, light, scene);
        }
    }
    return out;
}

}  // namespace kilolux
