// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "host/base/scene_features.h"
#include "kernels/shared/gbuffer.h"

namespace kilolux {

/// What a scene needs of a G-buffer: the plan that raster, bridge and kernels share.
struct GBufferNeeds : SceneFeatures {
    uint layout = GBUFFER_PACKED;  // GBUFFER_*
    float emissive_scale = 1.0f;   // largest emissive value, > 0
    bool operator==(const GBufferNeeds&) const = default;
};

/// Which planes a G-buffer has and where, for planes of stride * height elements.
GBufferLayout make_gbuffer_layout(const GBufferNeeds& needs, uint stride, uint height);

/// The layout GBUFFER_FULL of a scene with these features.
GBufferLayout full_gbuffer_layout(const SceneFeatures& features, uint stride, uint height);

/// Bytes of the one buffer that holds all planes.
std::size_t gbuffer_bytes(const GBufferLayout& layout, uint stride, uint height);

/// Bytes of one element of a plane; 0 if the layout does not have it.
uint plane_element_bytes(uint layout, uint plane);

/// "packed", "full", "half", "normal-xy", "oct-2x4".
std::string gbuffer_layout_name(uint layout);

/// Throws UsageError that lists the names when there is no such layout.
uint parse_gbuffer_layout(std::string_view name);

}  // namespace kilolux
