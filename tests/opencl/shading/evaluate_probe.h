// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tests/opencl/shading/shading_reference.h"

namespace kilolux {

/// Surfaces rounded to the device's floats, and the device's radiance of each.
struct ProbeResult {
    std::vector<SurfaceD> surfaces;
    std::vector<glm::dvec3> radiance;
};

/// Shades each surface by every light with kernels/shared/evaluate.h on the device, without a
/// G-buffer between. lighting.shading chooses the model; spots, metals and dielectrics of their own
/// are compiled in.
ProbeResult probe_evaluate(const std::vector<SurfaceD>& surfaces, const Lighting& lighting,
                           int lanes = 0);

/// (1 - sin2)^n on the device, by pow_of_cos2().
std::vector<float> probe_pow_of_cos2(const std::vector<float>& sin2, const std::vector<float>& n,
                                     int lanes = 0);

}  // namespace kilolux
