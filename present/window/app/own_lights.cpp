// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/own_lights.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "host/render/lights/light_rows.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_ranges.h"
#include "host/scene/lights/light_shape.h"

namespace kilolux {
namespace {

// Whether the renderer takes the light, once it has a range; a dark one is left out without harm.
bool is_good(SceneLight light) {
    if (light.intensity == glm::vec3(0.0f)) light.intensity = glm::vec3(1.0f);
    if (lacks_range(light)) light.range = kUnlimitedRange;
    return cone_problem(light).empty() && is_usable(light, glm::dvec3(0.0));
}

}  // namespace

OwnLights::OwnLights(std::vector<SceneLight> lights, double point_size)
    : lights_(std::move(lights)),
      point_size_(point_size),
      sent_point_size_(point_size),
      scene_point_size_(point_size) {
    count_kinds();
}

void OwnLights::count_kinds() {
    counts_.assign(kLightKinds.size(), 0);
    for (const SceneLight& light : lights_) ++counts_[static_cast<std::size_t>(light.type)];
    has_unranged_ = std::ranges::any_of(lights_, lacks_range);
}

void OwnLights::put(std::size_t light, const SceneLight& next) {
    if (lights_[light] == next) return;
    before_.try_emplace(light, std::exchange(lights_[light], next));
}

bool OwnLights::change(std::size_t light, SceneLight next) {
    if (light >= lights_.size() || !is_good(next)) return false;
    const SceneLight original = is_changed(light) ? originals_[light] : lights_[light];
    if (next.radius != lights_[light].radius) next.is_sized_point = false;
    put(light, next);
    originals_.insert_or_assign(light, original);
    if (next == original) originals_.erase(light);
    count_kinds();
    return true;
}

void OwnLights::reset(std::size_t light) {
    const auto found = originals_.find(light);
    if (found == originals_.end()) return;
    put(light, found->second);
    originals_.erase(found);
    count_kinds();
}

void OwnLights::reset() {
    for (const auto& [light, original] : std::exchange(originals_, {})) put(light, original);
    count_kinds();
}

void OwnLights::set_point_size(double radius) {
    if (std::exchange(point_size_, radius) == radius) return;
    for (auto& [light, original] : originals_) kilolux::set_point_size(original, radius);
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        SceneLight next = lights_[i];
        kilolux::set_point_size(next, radius);
        put(i, next);
    }
    count_kinds();
}

std::vector<NumberedLight> OwnLights::begin_sending() {
    std::vector<NumberedLight> out;
    out.reserve(before_.size());
    for (const auto& [light, before] : before_) out.push_back({light, lights_[light]});
    sent_before_ = std::exchange(before_, {});
    sent_point_size_ = point_size_;
    return out;
}

void OwnLights::end_sending(bool accepted) {
    const Lights sent = std::exchange(sent_before_, {});
    if (accepted) {
        scene_point_size_ = sent_point_size_;
        return;
    }
    for (const auto& [light, before] : sent) {
        SceneLight original = is_changed(light) ? originals_[light] : lights_[light];
        kilolux::set_point_size(original, scene_point_size_);
        lights_[light] = before;
        before_.erase(light);
        originals_.insert_or_assign(light, original);
        if (before == original) originals_.erase(light);
    }
    set_point_size(scene_point_size_);
    count_kinds();
}

int light_in_view(std::span<const SceneLight> lights, const Camera& camera) {
    // Of those before the camera the least angle to its axis, else the least distance.
    std::tuple<bool, double> best{true, 0.0};
    int out = -1;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (!kind_of(lights[i]).is_placed) continue;
        const glm::dvec3 view =
            glm::transpose(camera.world_from_view) * (lights[i].position - camera.position);
        const double across = glm::length(glm::dvec2(view));
        const bool is_behind = view.z >= 0.0;
        const double off = is_behind             ? glm::length(view)
                           : camera.orthographic ? across
                                                 : across / -view.z;
        if (out >= 0 && std::tuple(is_behind, off) >= best) continue;
        best = {is_behind, off};
        out = static_cast<int>(i);
    }
    return out;
}

}  // namespace kilolux
