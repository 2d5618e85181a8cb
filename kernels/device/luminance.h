// SPDX-License-Identifier: Apache-2.0
// Luminance of linear Rec. 709 light (ITU-R BT.709-6, item 3.2).
#ifndef KILOLUX_DEVICE_LUMINANCE_H
#define KILOLUX_DEVICE_LUMINANCE_H
#include "kernels/device/lanes.h"

static inline FV luminance(FV3 c) {
    return fma(c.z, fv(0.0722f), fma(c.y, fv(0.7152f), c.x * 0.2126f));
}
#endif
