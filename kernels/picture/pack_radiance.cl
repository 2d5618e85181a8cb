// SPDX-License-Identifier: Apache-2.0
// Radiance in planes -> pixels of four channels, as other renderers store them; alpha is 1.
// One work-item packs one pixel.
//
// RADIANCE_FORMAT  0: 4 floats; 1: 4 halves, of which the largest stands for what exceeds it;
//                  2: an image
#include "kernels/shared/types.h"
#include "kernels/shared/view.h"

#if RADIANCE_FORMAT == 2
#define PIXELS write_only image2d_t
#elif RADIANCE_FORMAT == 1
#define PIXELS global half* restrict
#else
#define PIXELS global float* restrict
#endif

kernel void pack_radiance(global const float* restrict radiance,  // [3][height][stride]
                          View view,
                          uint pitch,       // of `pixels` [pixel]
                          PIXELS pixels) {  // out [height][pitch][4]
    uint place = get_global_id(0);
    if (place >= view.width * view.height) return;
    uint x = place % view.width;
    uint y = place / view.width;
    uint plane_size = view.stride * view.height;
    global const float* from = radiance + y * view.stride + x;
    float4 value = (float4)(from[0], from[plane_size], from[2u * plane_size], 1.0f);
#if RADIANCE_FORMAT == 2
    write_imagef(pixels, (int2)((int)x, (int)y), value);
#elif RADIANCE_FORMAT == 1
    vstore_half4_rte(min(value, (float4)(65504.0f)), y * pitch + x, pixels);
#else
    vstore4(value, y * pitch + x, pixels);
#endif
}
