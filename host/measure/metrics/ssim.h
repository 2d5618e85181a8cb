// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/measure/metrics/rgb_image.h"

namespace kilolux {

/// Mean structural similarity of two display pictures, at most 1, which means equal.
///
/// Wang et al. 2004, "Image Quality Assessment: From Error Visibility to Structural Similarity":
/// 11x11 Gaussian window of sigma 1.5, K1 = 0.01, K2 = 0.03, L = 255, averaged over the windows
/// that lie inside the picture, on Rec. 709 luma of the sRGB codes. Empty when the picture is
/// smaller than the window. Throws Error when the sizes differ.
std::optional<double> ssim(const DisplayView& picture, const DisplayView& reference);

}  // namespace kilolux
