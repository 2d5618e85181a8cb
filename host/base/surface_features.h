// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kernels/shared/types.h"

namespace kilolux {

/// Surface features that are compiled into kernels and shaders that interpolate surfaces.
struct SurfaceFeatures {
    uint texture_uses = 0;  // bits 1 << USE_*
    bool texcoord0 = false;
    bool texcoord1 = false;
    bool vertex_color = false;
    bool tangents = false;
    bool nearest = false;       // filters other than linear between texels and between mip levels
    bool wraps = false;         // other than repeat
    bool uv_transform = false;  // KHR_texture_transform
    bool masks = false;         // cut by alpha
    bool coverage = false;      // only their coverage is needed: no normals
    int anisotropy = 1;         // samples along a footprint's longer side at most
    auto operator<=>(const SurfaceFeatures&) const = default;
};

/// The part of them that alpha reads, with one sample of its texture.
SurfaceFeatures alpha_features(SurfaceFeatures features);

/// Their macros with values, for OpenCL C and GLSL.
std::vector<std::pair<std::string, std::string>> surface_macros(const SurfaceFeatures& features);

}  // namespace kilolux
