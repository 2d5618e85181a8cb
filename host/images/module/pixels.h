// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/images/images.h"

namespace kilolux::oiio {

void apply_ocio(std::span<float> rgb, int width, const std::string& configuration,
                const OcioOptions& options);

TextMask text_mask(const std::string& text, int size);

}  // namespace kilolux::oiio
