// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/lights/photometry/photometric_web.h"

namespace kilolux {

/// Reads a photometric file of either format, told by its content: LM-63 (.ies) of the editions
/// 1986, 1991, 1995, 2002 and 2019, types A, B and C; EULUMDAT (.ldt), whose lines 2 and 3 are
/// numbers. A byte order mark of UTF-8 is left out. `where` starts the messages.
///
/// Symmetries are unfolded, all factors applied. A tilt's factors (TILT=INCLUDE) are for a lamp
/// that is not held as it was measured: they are skipped. Throws Error for TILT=<file> and whatever
/// is not a photometric web, in one line with the line's number and the value seen.
PhotometricWeb read_photometric_web(std::string text, const std::string& where);

}  // namespace kilolux
