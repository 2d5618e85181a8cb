// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/window/panel/panel.h"

namespace kilolux {

/// The section of the scene's own lights: it selects one and changes its numbers.
struct PanelLights : Panel {
    void own_lights(const CameraRig& rig) const;

 private:
    void select(const CameraRig& rig) const;
    void change(std::size_t number) const;
    bool change_color(SceneLight& light) const;
    bool change_numbers(SceneLight& light) const;
    bool change_position(SceneLight& light) const;
    bool change_aim(SceneLight& light) const;
    void reset() const;
};

}  // namespace kilolux
