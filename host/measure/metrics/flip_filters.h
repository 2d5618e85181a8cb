// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "host/measure/metrics/separable_filter.h"

namespace kilolux {

/// Blurs the three opponent planes as the eye does at this distance, by the contrast sensitivity
/// functions of Andersson et al. 2020, section 4.1.1 and table 1, as Gaussians.
std::array<Plane, 3> filter_contrast(const std::array<Plane, 3>& ycxcz, double pixels_per_degree);

/// Strength of edges and of points in a luminance plane of range 0..1 (ibid., section 4.2).
struct FlipFeatures {
    Plane edges;
    Plane points;
};
FlipFeatures detect_features(const Plane& luminance, double pixels_per_degree);

}  // namespace kilolux
