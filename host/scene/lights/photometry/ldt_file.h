// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "host/scene/lights/photometry/photometric_web.h"

namespace kilolux {

/// Whether the text is a EULUMDAT file and no IES file: its second and third lines are numbers, and
/// no line begins with "TILT=".
bool looks_like_ldt(std::string_view text);

/// Reads a EULUMDAT file (A. Stockmar 1990), as read_photometric_web() does; sets all but `name`
/// and `text`. Gamma is the vertical angle, C the horizontal one. Intensities are candela for 1000
/// lm of the lamps: times the flux of the first set of lamps and the conversion factor.
PhotometricWeb read_ldt(std::string_view text, const std::string& where);

}  // namespace kilolux
