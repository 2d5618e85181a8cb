// SPDX-License-Identifier: Apache-2.0
#include "present/window/overlay/light_outlines.h"

#include <imgui.h>

#include <algorithm>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "host/base/system/parallel.h"
#include "host/scene/lights/light_aim.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_shape.h"
#include "host/scene/lights/light_side.h"

namespace kilolux {
namespace {

constexpr int kRoundSteps = 48;  // lines of an ellipse or a circle
constexpr LineLook kSelectedLook{IM_COL32(255, 190, 70, 255), 2.0f};
constexpr LineLook kLook{IM_COL32(90, 200, 255, 190), 1.25f};
constexpr LineLook kShadow{IM_COL32(0, 0, 0, 130), 4.0f};  // below, so that white shows them, too
constexpr float kMarkRadius = 7.0f;  // of lights without a size, for a font of 15 pixels

std::vector<glm::dvec3> ellipse(const glm::dvec3& center, const LightEdges& axes) {
    std::vector<glm::dvec3> out;
    for (int i = 0; i < kRoundSteps; ++i) {
        const double angle = glm::two_pi<double>() * i / kRoundSteps;
        out.push_back(center + std::cos(angle) * axes.x + std::sin(angle) * axes.y);
    }
    return out;
}

// The circle in which the cone from the camera touches the sphere.
std::vector<glm::dvec3> silhouette(const SceneLight& light, const Camera& camera) {
    const glm::dvec3 to_eye = camera.orthographic ? glm::dvec3(camera.world_from_view[2])
                                                  : camera.position - light.position;
    const double distance = glm::length(to_eye), radius = light.radius;
    if (!camera.orthographic && !(distance > radius)) return {};
    const double share = camera.orthographic ? 0.0 : radius / distance;  // sine of its half angle
    const glm::dvec3 axis = to_eye / distance;
    const glm::dvec3 side = perpendicular_side(axis, glm::dvec3(camera.world_from_view[0]));
    const double across = radius * std::sqrt(1.0 - share * share);
    return ellipse(light.position + radius * share * axis,
                   {across * side, across * glm::cross(axis, side)});
}

void draw_closed(const ProjectedPicture& picture, const std::vector<glm::dvec3>& points,
                 const LineLook& look) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        picture.line(points[i], points[(i + 1) % points.size()], look);
    }
}

double eye_distance2(const Camera& camera, const glm::dvec3& position) {
    const glm::dvec3 from = position - camera.position;
    return glm::dot(from, from);
}

// Leaves the `most` values of which `key` is least.
template <typename T, typename Key>
void keep_nearest(std::vector<T>& values, std::size_t most, const Key& key) {
    if (values.size() <= most) return;
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(most), {}, key);
    values.resize(most);
}

// The selected light: its outline, or a circle, and a line the way that it shines.
void draw_selected(const ProjectedPicture& picture, const SceneLight& light, float scale) {
    const LightKind& kind = kind_of(light);
    if (!kind.is_placed) return;
    const std::vector<glm::dvec3> outline = outline_of(light, picture.camera());
    const double reach = is_area_light(light)
                             ? bounding_radius(light)
                             : 0.05 * glm::length(light.position - picture.camera().position);
    const std::optional<glm::vec2> at = picture.place_of(light.position);
    for (const LineLook& look : {kShadow, kSelectedLook}) {
        draw_closed(picture, outline, look);
        if (is_aimed_light(light)) {
            picture.line(light.position, light.position + reach * light.direction, look);
        }
        if (at && !is_area_light(light)) {
            picture.draw().AddCircle({at->x, at->y}, kMarkRadius * scale, look.color, 24,
                                     look.width);
        }
    }
}

}  // namespace

std::vector<glm::dvec3> outline_of(const SceneLight& light, const Camera& camera) {
    const auto [x, y] = edges_of(light);
    const glm::dvec3& p = light.position;
    switch (kind_of(light).shape) {
        case SHAPE_RECTANGLE:
            return {p - x - y, p + x - y, p + x + y, p - x + y};
        case SHAPE_DISK:
            return ellipse(p, {x, y});
        case SHAPE_SPHERE:
            return silhouette(light, camera);
        case SHAPE_TRIANGLE: {
            const auto corners = corners_of(p, {x, y});
            return {corners.begin(), corners.end()};
        }
        default:
            return {};
    }
}

std::vector<const SceneLight*> nearest_area_lights(std::span<const SceneLight> own,
                                                   std::span<const SceneLight> generated,
                                                   const Camera& camera, std::size_t most) {
    std::vector<const SceneLight*> out;
    for (const std::span<const SceneLight> lights : {own, generated}) {
        for (const SceneLight& light : lights) {
            if (is_area_light(light)) out.push_back(&light);
        }
    }
    keep_nearest(out, most,
                 [&](const SceneLight* light) { return eye_distance2(camera, light->position); });
    return out;
}

std::vector<SceneLight> nearest_generated_lights(const LightSearch& search, const Scene& scene,
                                                 std::size_t most) {
    const std::uint64_t count = search.options.count;
    if (count == 0 || count > kMostSearched || !(search.options.size > 0.0)) return {};
    const LightGenerator generator(search.options, scene, search.time);
    std::vector<std::pair<double, std::uint64_t>> numbers(count);  // by distance
    parallel_for(std::uint64_t{0}, count, [&](std::uint64_t i) {
        numbers[i] = {eye_distance2(search.camera, generator[i].position), i};
    });
    keep_nearest(numbers, most, std::identity{});
    std::vector<SceneLight> out;
    for (const auto& [distance, number] : numbers) out.push_back(generator[number]);
    return out;
}

const std::vector<SceneLight>& LightOutlines::nearest_generated(const PictureRequest& request) {
    const LightSearch wanted{request.settings.lights, request.time, request.camera};
    if (wanted == searched_) return nearest_;
    nearest_ = nearest_generated_lights(wanted, scene_, kMostOutlines);
    searched_ = wanted;
    return nearest_;
}

void LightOutlines::draw(ImDrawList& draw, std::span<const SceneLight> own, const ViewState& state,
                         const ShownPicture& shown) {
    const bool has_selected = state.light >= 0 && std::cmp_less(state.light, own.size());
    if (!shown.displayed || (!has_selected && !state.outlines)) return;
    const ProjectedPicture picture(draw, shown.displayed->camera, shown.place);
    if (state.outlines) {
        for (const SceneLight* light : nearest_area_lights(own, nearest_generated(*shown.displayed),
                                                           picture.camera(), kMostOutlines)) {
            draw_closed(picture, outline_of(*light, picture.camera()), kLook);
        }
    }
    if (has_selected) {
        draw_selected(picture, own[static_cast<std::size_t>(state.light)], shown.scale);
    }
}

}  // namespace kilolux
