// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/measure/metrics/rgb_image.h"

namespace kilolux {

/// A pixel loses light where it lacks more than this share of the reference's.
inline constexpr double kLosingShare = 0.01;

/// The light that a picture lacks and the light that it has too much. The light of a pixel is the
/// sum of its three channels, so that a lost blue light counts as much as a green one.
struct LostLight {
    double lost = 0.0;    // sum of what pixels lack, as a share of the reference's light
    double added = 0.0;   // sum of what pixels have too much, likewise; infinite if that is black
    double losing = 0.0;  // share of the reference's lit pixels that lose light, see kLosingShare
    int x = 0;            // of the pixel that lacks most [pixel], row 0 on top
    int y = 0;
};

/// All values must be finite. Throws Error when the sizes differ.
LostLight lost_light(const RgbImage& picture, const RgbImage& reference);

}  // namespace kilolux
