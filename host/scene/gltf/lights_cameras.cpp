// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/lights_cameras.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "host/scene/gltf/extensions.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_shape.h"
#include "host/scene/lights/light_side.h"

namespace kilolux {
namespace {

using nlohmann::json;

// A number of a light, `otherwise` without it; extras may hold anything.
double number_at(const json& source, std::string_view path, double otherwise) {
    const json* value = path.empty() ? nullptr : find_member(source, path);
    return value != nullptr && value->is_number() ? value->get<double>() : otherwise;
}

// The radius that extras give a light [m]; 0: none.
double radius_of(const json& source) { return number_at(source, "extras.radius", 0.0); }

const LightKind& kind_in_file(const json& source, std::string_view extension, double radius) {
    const std::string type = source.at("type");
    const LightKind* sized = radius > 0.0 ? find_light_kind(extension, type, true) : nullptr;
    return sized != nullptr ? *sized : *find_light_kind(extension, type);
}

// EXT_lights_area scales a light by the largest of its node's three scales.
double scale_of(const glm::dmat4& world_from_node) {
    const auto length = [&](int axis) { return glm::length(glm::dvec3(world_from_node[axis])); };
    return std::max({length(0), length(1), length(2)});
}

void read_flat_size(SceneLight& out, const json& source, const glm::dmat4& world_from_node) {
    const double height = number_at(source, "size", 1.0) * scale_of(world_from_node);
    out.height = to_float(height);
    out.width = to_float(height * number_at(source, kind_of(out).aspect_in_file, 1.0));
    const json* two_sided = find_member(source, kTwoSided);
    out.two_sided = two_sided != nullptr && *two_sided == json(true);
}

SceneLight convert_light(const GltfDocument& document, std::size_t e, std::size_t light,
                         const glm::dmat4& world_from_node = glm::dmat4(1.0)) {
    const json& source = document.lights[e][light];
    const double radius = radius_of(source);
    const LightKind& kind = kind_in_file(source, kLightExtensions[e], radius);
    SceneLight out;
    out.type = kind.type;
    if (kind.is_aimed) aim_light(out, world_from_node);
    out.position = glm::dvec3(world_from_node[3]);
    for (const LightNumber& number : kLightNumbers) {
        float& member = out.*number.member;
        if (kind.*number.has) member = to_float(number_at(source, number.paths[e], member));
    }
    if (kind.has_radius) out.radius = to_float(radius);
    if (kind.is_flat) read_flat_size(out, source, world_from_node);
    const double unit = kind.is_flat ? seen_area(out) : 1.0;  // nits become candela
    const auto color = source.value("color", std::array<double, 3>{1.0, 1.0, 1.0});
    const double intensity = source.value("intensity", default_intensity(kLightExtensions[e]));
    for (glm::length_t c = 0; c < 3; ++c) {
        out.intensity[c] = to_float(color[static_cast<std::size_t>(c)] * intensity * unit);
    }
    set_point_size(out, document.options.light_size);
    return out;
}

// The text `group` of extras, which may hold anything; empty without one.
std::string group_in(const tinygltf::Value& extras) {
    if (!extras.Has("group") || !extras.Get("group").IsString()) return "";
    return extras.Get("group").Get<std::string>();
}

// Says what is wrong with the radius in a light's extras; empty where nothing is.
std::string radius_problem(const json& source, std::string_view extension) {
    const json* radius = find_member(source, "extras.radius");
    if (radius == nullptr) return "";
    if (!radius->is_number()) return "extras.radius must be a number";
    if (*radius < 0.0) {
        return fmt::format("extras.radius is {}, must be at least 0", radius->get<double>());
    }
    const LightKind& kind = kind_in_file(source, extension, *radius);
    if (*radius == 0.0 || kind.has_radius) return "";
    return fmt::format("extras.radius: a light of type \"{}\" has none here, it is left out",
                       kind.name_in_file);
}

// Reports the first light of which `problem_of` says something, and how many more there are.
template <typename ProblemOf>
void report_problems(const GltfDocument& document, const ProblemOf& problem_of) {
    std::string first;
    std::size_t more = 0;
    for (std::size_t e = 0; e < kLightExtensions.size(); ++e) {
        for (std::size_t i = 0; i < document.lights[e].size(); ++i) {
            const std::string problem = problem_of(e, i);
            if (problem.empty()) continue;
            if (first.empty()) {
                first = element_name("lights", i) + ": " + problem;
            } else {
                ++more;
            }
        }
    }
    if (first.empty()) return;
    document.leave_out(more == 0 ? first : fmt::format("{}; likewise {} more", first, more));
}

// The text extras.group of a photometric file's light object; empty without one.
std::string profile_group(const GltfDocument& document, const tinygltf::Value& use) {
    const auto* extension = find_extension(document.model.extensions, kPhotometric);
    if (extension == nullptr || !extension->Has("lights")) return "";
    const tinygltf::Value& lights = extension->Get("lights");
    const int light = member_or(use, "light", 0);
    if (light < 0 || static_cast<std::size_t>(light) >= lights.ArrayLen()) return "";
    const tinygltf::Value& source = lights.Get(light);
    return source.Has("extras") ? group_in(source.Get("extras")) : "";
}

constexpr double kLeastAxesSine = 1e-6;  // of the angle between a camera's axes

void require(const GltfDocument& document, bool holds, const std::string& where, double value,
             const std::string& expected) {
    if (holds) return;
    document.fail(where, "is {}, must be {}", value, expected);
}

void read_perspective(const GltfDocument& document, const json& source, const std::string& where,
                      SceneCamera& out) {
    out.y_fov = source.at("yfov");
    out.aspect = source.value("aspectRatio", 0.0);
    out.z_near = source.at("znear");
    if (const double far = source.value("zfar", 0.0); far != 0.0) out.z_far = far;
    require(document, out.y_fov > 0.0 && out.y_fov < glm::pi<double>(), where + ".yfov", out.y_fov,
            "between 0 and pi");
    require(document, out.aspect >= 0.0, where + ".aspectRatio", out.aspect, "positive");
    require(document, out.z_near > 0.0, where + ".znear", out.z_near, "positive");
}

void read_orthographic(const GltfDocument& document, const json& source, const std::string& where,
                       SceneCamera& out) {
    const double x_extent = source.at("xmag"), y_extent = source.at("ymag");
    out.orthographic = true;
    out.y_extent = std::abs(y_extent);
    out.z_near = source.at("znear");
    out.z_far = source.at("zfar");
    require(document, x_extent != 0.0, where + ".xmag", x_extent, "other than 0");
    require(document, y_extent != 0.0, where + ".ymag", y_extent, "other than 0");
    require(document, out.z_near >= 0.0, where + ".znear", out.z_near, "at least 0");
    out.aspect = std::abs(x_extent) / out.y_extent;
}

SceneCamera convert_camera(const GltfDocument& document, std::size_t index,
                           const glm::dmat4& world_from_node, const std::string& node) {
    const json& source = document.cameras[index];
    SceneCamera out;
    if (const json* name = find_member(source, "name"); name != nullptr && name->is_string()) {
        out.name = *name;
    }
    out.world_from_camera = world_from_node;
    const glm::dvec3 y(world_from_node[1]);
    const glm::dvec3 z(world_from_node[2]);
    const double across = glm::length(glm::cross(y, z)) / (glm::length(y) * glm::length(z));
    if (!is_finite(world_from_node) || !(across > kLeastAxesSine)) {
        document.fail(node, "has a camera but a transform without direction");
    }
    const std::string type = source.at("type");
    const std::string where = element_name("cameras", index) + "." + type;
    const auto read = type == "orthographic" ? read_orthographic : read_perspective;
    read(document, source.at(type), where, out);
    require(document, out.z_far > out.z_near, where + ".zfar", out.z_far, "greater than znear");
    return out;
}

}  // namespace

bool aim_light(SceneLight& light, const glm::dmat4& world_from_node) {
    const glm::dvec3 x = glm::normalize(glm::dvec3(world_from_node[0]));
    const glm::dvec3 z = glm::normalize(glm::dvec3(world_from_node[2]));
    light.direction = glm::dvec3(0.0);
    if (!is_finite(z)) return false;
    light.direction = -z;
    light.side = perpendicular_side(light.direction, x);
    return glm::length(glm::cross(x, z)) > 0.0;
}

std::vector<SceneLight> convert_lights(const GltfDocument& document, const PlacedNodes& nodes) {
    std::vector<SceneLight> lights;
    for (const std::size_t n : nodes.in_scene) {
        if (nodes.visibility[n] == NodeVisibility::hidden) continue;
        for (std::size_t e = 0; e < kLightExtensions.size(); ++e) {
            const std::string extension(kLightExtensions[e]);
            const auto* use = find_extension(document.model.nodes[n].extensions, extension);
            if (use == nullptr || !use->Has("light")) continue;
            const auto light = static_cast<std::size_t>(member_or(*use, "light", 0));
            lights.push_back(convert_light(document, e, light, nodes.world_from_node[n]));
            lights.back().node = static_cast<int>(n);
            // A light that is hidden for a while stays, dark, so that kernels for its kind do.
            if (nodes.visibility[n] != NodeVisibility::visible) lights.back().intensity = {};
        }
    }
    return lights;
}

std::vector<LightNode> read_light_nodes(const GltfDocument& document) {
    std::vector<LightNode> out(document.model.nodes.size());
    for (std::size_t n = 0; n < out.size(); ++n) {
        const tinygltf::Node& node = document.model.nodes[n];
        const auto* profile = find_extension(node.extensions, kPhotometric);
        bool has_light = profile != nullptr;
        if (has_light) out[n].group = profile_group(document, *profile);
        for (std::size_t e = 0; e < kLightExtensions.size(); ++e) {
            const auto* use = find_extension(node.extensions, std::string(kLightExtensions[e]));
            if (use == nullptr || !use->Has("light")) continue;
            has_light = true;
            const auto light = static_cast<std::size_t>(member_or(*use, "light", 0));
            const json* group = find_member(document.lights[e][light], kExtrasGroup);
            if (group != nullptr && group->is_string()) out[n].group = *group;
        }
        if (!has_light) continue;
        out[n].name = node.name;
        const std::string group = group_in(node.extras);
        if (!group.empty()) out[n].group = group;
    }
    return out;
}

void report_lights(const GltfDocument& document) {
    const auto of_light = [&](std::string (*problem)(const SceneLight&)) {
        report_problems(document, [&](std::size_t e, std::size_t i) {
            return problem(convert_light(document, e, i));
        });
    };
    of_light(cone_problem);
    of_light(size_problem);
    report_problems(document, [&](std::size_t e, std::size_t i) {
        return radius_problem(document.lights[e][i], kLightExtensions[e]);
    });
}

std::vector<SceneCamera> convert_cameras(const GltfDocument& document, const PlacedNodes& nodes) {
    std::vector<SceneCamera> cameras;
    for (const std::size_t n : nodes.in_scene) {
        const int camera = document.model.nodes[n].camera;
        if (camera < 0) continue;
        cameras.push_back(convert_camera(document, static_cast<std::size_t>(camera),
                                         nodes.world_from_node[n], node_name(document, n)));
    }
    return cameras;
}

}  // namespace kilolux
