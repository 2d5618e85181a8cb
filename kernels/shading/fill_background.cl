// SPDX-License-Identifier: Apache-2.0
// Fills the pixels without a surface with the environment's light. One work-item fills VW
// neighbouring pixels of a row.
#include "kernels/device/lit_item.h"
#include "kernels/shading/environment.h"

// World direction of the ray through a pixel, of any length.
static inline FV3 ray_direction(View view, Pixels pixels) {
    FV3 p = view_position(view, pixels.x, pixels.y, fv(1.0f));
    if (view.orthographic != 0u) p = fv3(fv(0.0f), fv(0.0f), fv(-1.0f));
    return rotate_to_world(view, p);
}

kernel void fill_background(GBUFFER_ARGS,
                            uint everywhere,  // 1: there are no surfaces, and no G-buffer
                            global const float* restrict texels,  // RGB, [texels of all levels][3]
                            uint4 size,  // of the level: width, height, first texel
                            global float* restrict radiance) {  // in, out [3][height][stride]
    ItemPlace at = place_in_planes(view);
    if (!at.inside) return;
    Pixels pixels = row_pixels(view, at.x, at.y);
    MASK open = within_width(view, pixels);
    if (everywhere == 0u) {
        open &= lane_mask(load_depth01(GBUFFER_OF_ARGS, pixels) == fv(BACKGROUND_DEPTH));
    }
    if (!lane_any(open)) return;
    MapTexels t = texels_towards(ray_direction(view, pixels), size);
    uint plane_size = view.stride * view.height;
    for (uint channel = 0; channel < 3u; ++channel) {
        global float* plane = radiance + channel * plane_size + pixels.first;
        FV kept = everywhere != 0u ? fv(0.0f) : lane_load(plane);
        lane_store(lane_select(open, filtered(texels, t, channel), kept), plane);
    }
}
