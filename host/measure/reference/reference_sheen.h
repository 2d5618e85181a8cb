// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "host/measure/reference/surface_samples.h"

namespace kilolux {

/// KHR_materials_sheen in double: D V n.l [1/sr] of white sheen, with n.v at least 1e-4 and
/// alpha = max(roughness, 0.045)^2. `to_light` is unit, or shorter for a light nearer than 1 cm.
double reference_sheen(const SurfaceSample& surface, const glm::dvec3& to_eye,
                       const glm::dvec3& to_light);

/// E of the extension's text at a cosine: SHEEN_ALBEDO_ROWS of kernels/shared/lobes/sheen.h.
double reference_sheen_albedo(double cosine, double roughness);

/// sheenAlbedoScaling: what the sheen leaves to the surface below it, by the cosines to the eye and
/// to the light.
double reference_below_sheen(const SurfaceSample& surface, double n_dot_v, double n_dot_l);

}  // namespace kilolux
