// SPDX-License-Identifier: Apache-2.0
// Linear HDR radiance -> 8-bit sRGB: exposure, tone curve, transfer function, exact rounding.
// One work-item makes VW neighbouring pixels of a row.
#include "kernels/device/arguments.h"
#include "kernels/device/display.h"

kernel void tonemap(global const float* restrict radiance,  // [3][height][stride]
                    uint pixel_count,                       // height * stride
                    float4 backdrop,  // light that is shown as backdrop_code; NaN: none
                    uint backdrop_code, DISPLAY_ARGS) {
    uint pixel = (uint)get_global_id(0) * VW;
    if (pixel >= pixel_count) return;
    DisplayCurve curve = {gain, SRGB_TABLE_OF_ARGS};
    FV3 c = fv3(lane_load(radiance + pixel), lane_load(radiance + pixel_count + pixel),
                lane_load(radiance + 2 * pixel_count + pixel));
    MASK shown = is_backdrop(c, fv3(fv(backdrop.x), fv(backdrop.y), fv(backdrop.z)));
    lane_store(lane_select_uint(shown, lane_uint(backdrop_code), display_codes(curve, c)),
               display + pixel);
}
