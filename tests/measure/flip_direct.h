// SPDX-License-Identifier: Apache-2.0
// LDR-FLIP written a second time, pixel by pixel with two-dimensional filter windows, from the
// formulas of Andersson et al. 2020: slow, without separable filters, and without any code of
// host/measure.
#pragma once

#include <vector>

namespace kilolux::direct {

/// Error map of two linear Rec. 709 pictures in [0, 1], 3 * width * height values each.
std::vector<double> flip(const std::vector<double>& a, const std::vector<double>& b, int width,
                         int height, double pixels_per_degree);

/// The error of two uniform pictures: filters change nothing, so only the colours count.
double uniform_flip(const double (&a)[3], const double (&b)[3]);

}  // namespace kilolux::direct
