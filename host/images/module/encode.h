// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/images/images.h"

namespace kilolux::oiio {

std::vector<unsigned char> encode_pixels(const std::string& name, const std::string& format,
                                         const ImageLayout& layout,
                                         std::span<const unsigned char> pixels,
                                         std::size_t pixel_stride);
std::unique_ptr<ImageWriter> open_writer(const std::string& name, const std::string& format,
                                         const ImageLayout& layout, int file);

}  // namespace kilolux::oiio
