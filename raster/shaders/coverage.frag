#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Coverage of surfaces, without the parts that the alpha mask cuts: the triangle of each pixel
// (WRITES_IDS), or 1 for every fragment that is kept (WRITES_COUNT), or depth alone.
#include "raster/shaders/surface.glsl"

#if WRITES_IDS
layout(location = 0) out uint out_id;  // 0 is background
#elif WRITES_COUNT
layout(location = 0) out float out_count;  // the framebuffer adds them up
#endif

void main() {
#if HAS_MASKS
    SurfaceScene scene = SurfaceScene(0u);
    if (!is_covered(scene, drawn_fragment(scene))) discard;
#endif
#if WRITES_IDS
    out_id = scene_instances[drawn_instance].first_triangle + uint(gl_PrimitiveID) + 1u;
#elif WRITES_COUNT
    out_count = 1.0;
#endif
}
