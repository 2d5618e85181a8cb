// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/scene/scene.h"

namespace kilolux {

/// What a scene shows to points within it and to viewers outside. Shares, from 0 to 1.
struct Enclosure {
    SceneKind kind = SceneKind::open;
    std::string reason{};  // for the user: why it is an interior, or why it is none
    double within = 0.0;   // of the rays from a point within: they meet front faces
    double open = 0.0;     // of the view of front faces: outside
    double reached = 0.0;  // the same of the faces that a viewer outside or light from the point
                           // reaches; 0: not measured
    double room = 0.0;     // of the box's volume: a point within sees it
    double backs = 0.0;    // of what is seen from outside: backs of walls and ceilings
};

/// `interior`: at least half of the rays from a point within meet front faces, less than a third of
/// the view of front faces is outside, and a room encloses the point. A room of thin walls shows
/// their backs to viewers outside: a quarter of what they see. A hall with outer walls is much of
/// the scene: the point sees a quarter of the box, or a tenth where no ray leaves the hall, and
/// light from there reaches much of the surfaces that face no viewer outside. `closed`: at least
/// half of the rays from the box's middle meet back faces. Else `open`.
Enclosure enclosure_of(const Scene& scene, const Box& box);

}  // namespace kilolux
