// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/scene/lights/photometry/photometric_web.h"

namespace kilolux {

/// Photometry of types A and B (IES LM-75): both have the light's direction at vertical and
/// horizontal angle 0, and see the half-space in front of it. V is positive upwards, H to the
/// right. The pole of type A points up: H turns about it, V rises from the horizontal plane to it.
/// That of type B points to the right: V turns about it, H goes from the vertical plane to it.
enum class PoleType { up, right };

struct PoleGrid {
    PoleType pole = PoleType::right;
    std::vector<double> vertical, horizontal;  // [deg] rising, within -90 to 90; two or more each
    std::vector<double> candela;               // [horizontal][vertical]
};

/// Gives the web C-planes with the grid's values: direction (V, H) = (0, 0) is vertical angle 0,
/// up is horizontal angle 0 and right is 90. A grid that starts at 0 is mirrored; beyond its angles
/// there is no light. The web's vertical angles are at most half as far apart as the grid's nearest
/// ones, from 0.1 to 0.5 degrees, its planes 0.5; table_error has the largest error in the grid's
/// directions. Leaves a peak of 0 where no direction has light.
void set_pole_grid(PhotometricWeb& web, PoleGrid grid);

}  // namespace kilolux
