// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/scene.h"

namespace kilolux {

/// Where a light that is_aimed_light() points, as angles [degrees].
struct LightAim {
    double azimuth = 0.0;    // the way that it shines, seen from above: 0 is -Z, 90 is +X
    double elevation = 0.0;  // of that way over the horizon, -90 to 90: 90 is +Y
    double roll = 0.0;       // of its side about that way: 0 is level; looking along it, 90 is up
    bool operator==(const LightAim&) const = default;
};

/// The aim of a light with a direction; azimuth and roll from -180 to 180. Straight up and down
/// the azimuth is 0, and the roll tells how the light is turned.
LightAim aim_of(const SceneLight& light);

/// Gives the light this direction and side, both unit.
void set_aim(SceneLight& light, const LightAim& aim);

}  // namespace kilolux
