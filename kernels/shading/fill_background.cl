// SPDX-License-Identifier: Apache-2.0
// The environment's light where no surface covers a pixel. One work-item fills VW neighbouring
// pixels of a row.
#include "kernels/device/lanes.h"
#include "kernels/device/pixels.h"
#include "kernels/shading/environment.h"
#include "kernels/shared/view.h"

// World direction of the ray through a pixel, of any length.
static inline FV3 ray_direction(View view, Pixels pixels) {
    FV3 p = view_position(view, pixels.x, pixels.y, fv(1.0f));
    if (view.orthographic != 0u) p = fv3(fv(0.0f), fv(0.0f), fv(-1.0f));
    return rotate_to_world(view, p);
}

kernel void fill_background(global const uchar* restrict gbuffer,  // one byte where `everywhere`
                            uint depth_offset,                     // of the depth plane [byte]
                            uint everywhere,                       // 1: there are no surfaces
                            View view,
                            global const float* restrict texels,  // RGB, [texels of all levels][3]
                            uint4 size,  // of the level: width, height, first texel
                            global float* restrict radiance) {  // in, out [3][height][stride]
    uint x = (uint)get_global_id(0) * VW;
    uint y = get_global_id(1);
    if (y >= view.height) return;
    Pixels pixels = row_pixels(view, x, y);
    MASK open = within_width(view, pixels);
    if (everywhere == 0u) {
        global const float* depth01 = (global const float*)(gbuffer + depth_offset);
        open &= lane_mask(lane_load(depth01 + pixels.first) == fv(0.0f));
    }
    if (!lane_any(open)) return;
    Texels t = texels_towards(ray_direction(view, pixels), size);
    uint plane_size = view.stride * view.height;
    for (uint channel = 0; channel < 3u; ++channel) {
        global float* plane = radiance + channel * plane_size + pixels.first;
        FV other = everywhere != 0u ? fv(0.0f) : lane_load(plane);
        lane_store(lane_select(open, filtered(texels, t, channel), other), plane);
    }
}
