// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/scene.h"

namespace kilolux {

/// The space of generated lights: a box, or a box with a hole.
struct LightRegion {
    Box outer;
    Box hole;  // inside `outer`; empty: none
    bool operator==(const LightRegion&) const = default;
};

/// The region that a scene's kind asks for, when no box is given:
///
///   interior        the box of its surfaces less a fiftieth at each wall
///   closed, flat    a shell around the box, a quarter of its diagonal thick; it begins as far from
///                   the box as `gap` says, at most a twentieth of the diagonal
///   open            the box of its surfaces and a tenth of its diagonal around it
///
/// Flat: the thinnest side is below a twentieth of the diagonal. A scene with a light_box has that,
/// an empty one a box of 2 m.
LightRegion light_region(const Scene& scene, double gap);

/// Nearer to a light than this [m] the inverse square stops growing: 1 cm; in scenes with a
/// diagonal below 4 m a four-hundredth of it, rounded down to 1 cm over a power of two, so that
/// scenes of like size share their kernels.
float light_d_min(const Scene& scene);

}  // namespace kilolux
