// SPDX-License-Identifier: Apache-2.0
// Pictures for the eye that 8 bits and our own tone curves do not make: 16 bits, and OpenColorIO.
#pragma once

#include <string>
#include <vector>

#include "host/picture/frame.h"
#include "host/render/settings.h"

namespace kilolux {

/// Which transform of the configuration in $OCIO makes the display picture.
struct OcioOptions {
    std::string display;  // empty: the configuration's default
    std::string view;     // empty: the display's default; "none": OpenColorIO stays out
    std::string input;    // colour space of our light; empty: a linear Rec. 709 one by its usual
                          // names, else the role scene_linear
};

/// Whether $OCIO is set and the options do not say "none". Throws UsageError for options that need
/// $OCIO where it is not set.
bool uses_ocio(const OcioOptions& options);

/// The colours a file for the eye holds, RGB from 0 to 1, encoded for the display: exposure, then
/// OpenColorIO's view or our tone curve and sRGB. Of a frame that shows something else than light
/// (settings.want.view), what Frame::display says. Throws Error with OpenColorIO's reason, and
/// UsageError for displays, views and spaces that the configuration lacks.
std::vector<float> display_colours(const Frame& frame, const RenderSettings& settings,
                                   const OcioOptions& ocio);

}  // namespace kilolux
