// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace kilolux {

/// Exposure [EV] that gives the lit pixels of a linear picture, `radiance` of 3 floats each, a log
/// average luminance of middle grey, 0.18 (Reinhard et al. 2002, "Photographic Tone Reproduction
/// for Digital Images", equation 1), or less, so that at most 2 % of them have a channel above 1:
/// this keeps a dark model's highlights. Rounded to hundredths, so that the printed value is the
/// one in use; 0 for a black picture.
float automatic_exposure(std::span<const float> radiance);

}  // namespace kilolux
