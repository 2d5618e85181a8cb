// SPDX-License-Identifier: Apache-2.0
#include "present/commands/picture_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace kilolux {
namespace {

// Where the scene's box lies in the view: beyond which planes all its corners are.
std::string place_in_view(const Box& box, const Camera& camera, double aspect) {
    const double half = camera.orthographic ? camera.y_extent : std::tan(0.5 * camera.y_fov);
    std::array<bool, 4> beyond;
    beyond.fill(true);
    double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
    for (std::size_t i = 0; i < 8; ++i) {
        const glm::dvec3 v = (box.corner(i) - camera.position) * camera.world_from_view;
        const double edge = camera.orthographic ? half : -v.z * half;
        nearest = std::min(nearest, -v.z);
        farthest = std::max(farthest, -v.z);
        const std::array<bool, 4> sides = {v.x > edge * aspect, v.x<-edge * aspect, v.y> edge,
                                           v.y < -edge};
        for (std::size_t side = 0; side < 4; ++side) beyond[side] = beyond[side] && sides[side];
    }
    if (farthest <= 0.0 && !camera.orthographic) return "behind the camera";
    if (farthest <= camera.z_near) return "nearer than the camera's near plane";
    if (nearest >= camera.z_far) return "beyond the camera's far plane";
    for (std::size_t side = 0; side < 4; ++side) {
        if (beyond[side]) return "beside the camera's view";
    }
    return "";
}

// Whether any triangle faces the camera or is double-sided.
bool any_face_shows(const Scene& scene, const Camera& camera) {
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const bool mirrored = glm::determinant(glm::dmat3(instance.world_from_object)) < 0.0;
        if (material_of(scene, mesh).double_sided) return true;
        const auto corner = [&](std::size_t i) {
            return glm::dvec3(instance.world_from_object *
                              glm::dvec4(mesh.positions[mesh.indices[i]], 1.0));
        };
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            const glm::dvec3 a = corner(i);
            const glm::dvec3 normal = glm::cross(corner(i + 1) - a, corner(i + 2) - a);
            const glm::dvec3 to_eye =
                camera.orthographic ? camera.world_from_view[2] : camera.position - a;
            if ((glm::dot(normal, to_eye) > 0.0) != mirrored) return true;
        }
    }
    return false;
}

std::string why_no_surface(const Scene& scene, const Camera& camera, double aspect, bool framed) {
    const Box box = bounds(scene);
    if (box.empty()) return "the scene has no triangles";
    const std::string place = place_in_view(box, camera, aspect);
    if (!place.empty()) {
        return fmt::format("the scene is {}; {}", place,
                           framed ? "the automatic camera frames it as it is at --time"
                                  : "try --camera-index auto");
    }
    if (!any_face_shows(scene, camera)) {
        const bool inside = scene.kind == SceneKind::interior;
        return fmt::format("all faces are turned away from the camera; try {}",
                           !framed  ? "--camera-index auto"
                           : inside ? "--view outside"
                                    : "--view inside");
    }
    return "no surface covers a pixel's centre: all that is in the view is cut by alpha, turned "
           "away, or smaller than a pixel";
}

}  // namespace

std::string picture_advice(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                           const FrameStats& stats, bool framed) {
    if (settings.want.view != ViewKind::lit) return "";
    const double aspect = static_cast<double>(settings.width) / settings.height;
    // Surfaces that blend are in no cluster.
    const bool counted =
        settings.renderer == RendererKind::deferred && !has_blended_surfaces(scene);
    const auto in_view = [&] {
        const Box box = bounds(scene);
        return !box.empty() && place_in_view(box, camera, aspect).empty();
    };
    if (counted ? stats.active_clusters == 0 : !in_view()) {
        return "picture is empty: " + why_no_surface(scene, camera, aspect, framed);
    }
    if (settings.reflections) return "";
    if (stats.lights_used == 0) {
        return stats.lights_given == 0
                   ? "picture has no lights, only ambient and emitted light; try --rig studio"
                   : fmt::format(
                         "picture has no usable lights, all {} were rejected; try "
                         "--rig studio",
                         stats.lights_given);
    }
    if (counted && stats.directional_lights == 0 && stats.refined_pairs == 0) {
        return fmt::format(
            "picture has only ambient and emitted light: none of {} lights reaches a surface in "
            "it; try --rig studio",
            stats.lights_used);
    }
    if (settings.shadows != Shadows::off && stats.lights_used == stats.directional_lights) {
        return "picture has no shadows: all its lights are directional, which cast none; try --rig "
               "swarm";
    }
    return "";
}

}  // namespace kilolux
