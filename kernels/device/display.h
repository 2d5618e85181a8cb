// SPDX-License-Identifier: Apache-2.0
// Linear HDR radiance -> 8-bit sRGB: exposure, tone curve, transfer function, exact rounding.
#ifndef KILOLUX_DEVICE_DISPLAY_H
#define KILOLUX_DEVICE_DISPLAY_H
#include "kernels/device/srgb.h"
#include "kernels/shared/tone_curve.h"

#ifndef TONE_CURVE
#define TONE_CURVE TONE_CURVE_NEUTRAL
#endif

// From radiance to codes, beside TONE_CURVE.
typedef struct DisplayCurve {
    float gain;  // 2^exposure
    SrgbTable table;
} DisplayCurve;

// NaN and negative light are black and infinite light is white: tone curves do not see them.
static inline FV displayable(FV v) { return min(lane_select(v > fv(0.0f), v, fv(0.0f)), fv(1e9f)); }

// R | G << 8 | B << 16 | 255 << 24.
static inline UV display_codes(DisplayCurve by, FV3 radiance) {
    FV3 c = fv3(displayable(radiance.x * by.gain), displayable(radiance.y * by.gain),
                displayable(radiance.z * by.gain));
    c = tone_curve_of(TONE_CURVE, c);
    UV r = srgb_code(by.table, c.x);
    UV g = srgb_code(by.table, c.y);
    UV b = srgb_code(by.table, c.z);
    return r | (g << 8) | (b << 16) | 0xff000000u;
}
#endif
