// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/image/image_file.h"

namespace kilolux {

/// Throws Error if the file is not there or cannot be read.
FloatImage read_image(const std::filesystem::path& file);

/// Width and height by the file's header. Throws as read_image().
std::pair<int, int> image_size(const std::filesystem::path& file);

/// The colour of an image, 3 * width * height: R, G, B by name, else its first three channels, or
/// its only one three times. Throws Error for an image without channels.
std::vector<float> colour_of(const FloatImage& image);

}  // namespace kilolux
