// SPDX-License-Identifier: Apache-2.0
// Display pictures of 16 bits a channel or by OpenColorIO, which the renderer does not make.
#pragma once

#include <string>
#include <vector>

#include "host/images/images.h"
#include "host/picture/frame.h"
#include "host/render/settings.h"

namespace kilolux {

/// The file that $OCIO names; null if none.
const char* ocio_config();

/// Whether $OCIO is set and the options do not say "none". Throws UsageError for options that need
/// $OCIO where it is not set.
bool uses_ocio(const OcioOptions& options);

/// Frame::display as RGB codes from 0 to 1, as read_image() gives those of a file.
std::vector<float> display_codes(const Frame& frame);

/// RGB from 0 to 1 as Frame::display, each code the nearest.
void set_display(Frame& frame, const std::vector<float>& rgb);

/// The picture as RGB from 0 to 1, encoded for the display: exposure, then OpenColorIO's view or
/// the tone curve and sRGB. A debug view (settings.want.view) is an unchanged Frame::display.
/// Throws Error with OpenColorIO's reason, UsageError for displays, views and spaces that the
/// configuration lacks.
std::vector<float> display_colours(const Frame& frame, const RenderSettings& settings,
                                   const OcioOptions& ocio);

}  // namespace kilolux
