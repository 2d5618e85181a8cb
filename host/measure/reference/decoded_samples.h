// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "host/measure/reference/surface_samples.h"
#include "host/picture/decoded_surfaces.h"

namespace kilolux {

/// One decoded pixel, of which `value(SURFACE_*)` gives each plane. `specular`, `unlit`: as in
/// DecodedSurfaces.
SurfaceSample surface_sample(const std::function<double(std::size_t)>& value, bool specular,
                             bool unlit);

/// A decoded G-buffer as a reference shades it: float32 values as they are, normals not made unit
/// again, since the kernels take them so too. Background where the depth is 0.
SurfaceSamples surface_samples(const DecodedSurfaces& decoded);

}  // namespace kilolux
