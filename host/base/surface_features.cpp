// SPDX-License-Identifier: Apache-2.0
#include "host/base/surface_features.h"

#include "kernels/shared/material.h"

namespace kilolux {

SurfaceFeatures alpha_features(SurfaceFeatures features) {
    features.anisotropy = 1;
    features.texture_uses &= 1u << USE_BASE_COLOR;
    features.tangents = false;
    return features;
}

std::vector<std::pair<std::string, std::string>> surface_macros(const SurfaceFeatures& features) {
    const auto flag = [](bool value) { return std::string(value ? "1" : "0"); };
    return {{"TEXTURE_USES", std::to_string(features.texture_uses)},
            {"HAS_TEXCOORD0", flag(features.texcoord0)},
            {"HAS_TEXCOORD1", flag(features.texcoord1)},
            {"HAS_VERTEX_COLOR", flag(features.vertex_color)},
            {"HAS_NEAREST", flag(features.nearest)},
            {"HAS_WRAPS", flag(features.wraps)},
            {"HAS_UV_TRANSFORM", flag(features.uv_transform)},
            {"HAS_TANGENT", flag(features.tangents)},
            {"MAX_ANISOTROPY", std::to_string(features.anisotropy)}};
}

}  // namespace kilolux
