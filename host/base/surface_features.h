// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kernels/shared/types.h"

namespace kilolux {

/// What of surfaces is compiled into kernels and shaders that interpolate them.
struct SurfaceFeatures {
    uint texture_uses = 0;  // bits 1 << USE_*
    bool texcoord0 = false;
    bool texcoord1 = false;
    bool vertex_color = false;
    bool nearest = false;       // filters other than linear between texels and between mip levels
    bool wraps = false;         // other than repeat
    bool uv_transform = false;  // KHR_texture_transform
    bool masks = false;         // cut by alpha
    bool coverage = false;      // only where they are: no normals
    int anisotropy = 1;         // samples along a footprint's longer side at most
    auto operator<=>(const SurfaceFeatures&) const = default;
};

/// Their macros with values, for OpenCL C and GLSL.
std::vector<std::pair<std::string, std::string>> surface_macros(const SurfaceFeatures& features);

}  // namespace kilolux
