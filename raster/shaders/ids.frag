#version 450 core
// SPDX-License-Identifier: Apache-2.0
// The triangle that a pixel shows, less what the alpha mask cuts away.
#include "raster/shaders/material.glsl"

layout(location = 6) flat in uint v_first_triangle;
layout(location = 0) out uint out_id;  // 0 is background

void main() {
#if ALPHA_MASK
    if (sample_base_color().a < material.emissive_cutoff.w) discard;
#endif
    out_id = v_first_triangle + uint(gl_PrimitiveID) + 1u;
}
