// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <vector>

#include "host/scene/animated_scene.h"
#include "host/scene/camera.h"

namespace kilolux {

/// A copy of the scene's lights with the user's changes. The worker owns the scene's lights;
/// begin_sending() returns what it must update.
class OwnLights {
 public:
    /// `point_size`: the radius that the points of `lights` without one have got [m].
    OwnLights(std::vector<SceneLight> lights, double point_size);

    const std::vector<SceneLight>& lights() const { return lights_; }
    std::size_t count(LightType type) const { return counts_[static_cast<std::size_t>(type)]; }
    bool has_unranged() const { return has_unranged_; }

    bool is_changed(std::size_t light) const { return originals_.contains(light); }
    std::size_t changed_count() const { return originals_.size(); }

    /// Changes a light. Returns false, and keeps what it was, where the renderer could not use the
    /// numbers: not finite, no size, an impossible cone.
    bool change(std::size_t light, SceneLight next);
    /// Restores a light, or all, as loaded.
    void reset(std::size_t light);
    void reset();
    /// Gives the points without a radius of their own this one [m], 0: none.
    void set_point_size(double radius);
    double point_size() const { return point_size_; }

    /// has_news: some changes are not sent yet. begin_sending() returns them for exchange_lights().
    /// end_sending() must follow before the next begin_sending(). If the scene refused them, it
    /// restores the lights.
    bool has_news() const { return !before_.empty(); }
    std::vector<NumberedLight> begin_sending();
    void end_sending(bool accepted);

 private:
    using Lights = std::map<std::size_t, SceneLight>;  // by number

    void put(std::size_t light, const SceneLight& next);
    void count_kinds();

    std::vector<SceneLight> lights_;
    Lights originals_;             // of changed lights
    Lights before_, sent_before_;  // what the scene has of lights to be sent, and of sent ones
    double point_size_, sent_point_size_, scene_point_size_;  // [m]
    std::vector<std::size_t> counts_;                         // by LightType
    bool has_unranged_ = false;
};

/// The number of the light that the camera sees nearest to the middle of its picture, else of the
/// nearest one; -1: there is none with a position.
int light_in_view(std::span<const SceneLight> lights, const Camera& camera);

}  // namespace kilolux
