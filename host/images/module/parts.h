// SPDX-License-Identifier: Apache-2.0
// The functions of images.h as libkilolux_images.so has them, each in a file of this folder.
#pragma once

#include <OpenImageIO/imageio.h>

#include "host/images/images.h"

namespace kilolux::oiio {

OIIO::TypeDesc type_of(SampleType type);

/// The lines of OpenImageIO's reasons with "; " between them.
std::string one_line(const std::string& reasons);

std::vector<unsigned char> encode_pixels(const std::string& name, const std::string& format,
                                         const ImageLayout& layout,
                                         std::span<const unsigned char> pixels,
                                         std::size_t pixel_stride);
std::unique_ptr<ImageWriter> open_writer(const std::string& name, const std::string& format,
                                         const ImageLayout& layout, int file);
std::unique_ptr<ImageReader> open_image(const std::filesystem::path& file);
std::unique_ptr<ImageReader> open_encoded(const std::string& format,
                                          std::span<const unsigned char> bytes);
void apply_ocio(std::span<float> rgb, int width, const std::string& configuration,
                const OcioOptions& options);
TextMask text_mask(const std::string& text, int size);

}  // namespace kilolux::oiio
