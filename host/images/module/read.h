// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/images/images.h"

namespace kilolux::oiio {

std::unique_ptr<ImageReader> open_image(const std::filesystem::path& file);
std::unique_ptr<ImageReader> open_encoded(const std::string& format,
                                          std::span<const unsigned char> bytes);

}  // namespace kilolux::oiio
