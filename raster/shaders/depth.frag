#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Depth alone, less what the alpha mask cuts away.
#include "raster/shaders/material.glsl"

void main() {
#if ALPHA_MASK
    if (sample_base_color().a < material.emissive_cutoff.w) discard;
#endif
}
