// SPDX-License-Identifier: Apache-2.0
// Scenes whose lights have no range, and how pictures of them compare with the unlimited lights.
#pragma once

#include <string>
#include <vector>

#include "host/render/renderer.h"

namespace kilolux {

/// A scene of lights without a range.
struct TailScenario {
    std::string name;
    Scene scene;
    Camera camera;
};

/// The camera among all lights; intensities over e^40; one light that outshines the rest by 1e12;
/// spots and points; a light within a micrometre of a surface.
std::vector<TailScenario> tail_scenarios();

/// A picture of bounded, exact or grouped lights against float64 lights without an end, on the same
/// decoded surfaces. Values are of a pixel's colour.
struct TailAgreement {
    int values = 0;
    double largest_error = 0.0;     // of |picture - reference| / E, E as in ReferencePicture::scale
    int below = 0;                  // values whose bound is less than their error, by over 1e-5 E
    std::vector<double> looseness;  // bound / error of the values that err by more than 1e-4 E
};

/// `settings` with Tails::exact, bounded or tree; the AOV error-bound is asked for.
TailAgreement compare_tails(const TailScenario& scenario, RenderSettings settings);

}  // namespace kilolux
