// SPDX-License-Identifier: Apache-2.0
// Between image_file.cpp and the layout of EXR files.
#pragma once

#include <OpenImageIO/imageio.h>

#include <vector>

#include "present/image/image_file.h"

namespace kilolux {

/// How an EXR file describes itself and its channels: colour, then every layer's, in order.
OIIO::ImageSpec exr_spec(const Frame& frame, const ImageNotes& notes, const ImageOptions& options);

/// Pixels as that spec lays them out: interleaved, each channel in its own format.
std::vector<unsigned char> exr_pixels(const Frame& frame, const OIIO::ImageSpec& spec);

}  // namespace kilolux
