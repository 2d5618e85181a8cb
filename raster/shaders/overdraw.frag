#version 450 core
// SPDX-License-Identifier: Apache-2.0
// One for every fragment that is kept; the framebuffer adds them up.
#include "raster/shaders/material.glsl"

layout(location = 0) out float out_count;

void main() {
#if ALPHA_MASK
    if (sample_base_color().a < material.emissive_cutoff.w) discard;
#endif
    out_count = 1.0;
}
