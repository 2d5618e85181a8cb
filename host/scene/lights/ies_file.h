// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/lights/photometric_web.h"

namespace kilolux {

/// Reads an IES file: LM-63-1986, -1991, -1995, -2002 and -2019. `where` starts the messages.
///
/// Symmetries are unfolded, multiplier and ballast factor applied. A tilt's factors (TILT=INCLUDE)
/// are for a lamp that is not held as it was measured: they are skipped. Throws Error for
/// photometry of type A or B, TILT=<file>, and whatever is not a photometric web.
PhotometricWeb read_photometric_web(std::string text, const std::string& where);

}  // namespace kilolux
