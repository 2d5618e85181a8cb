// SPDX-License-Identifier: Apache-2.0
// What libkilolux_images.so exports: the functions of images.h, under one C name.
#pragma once

#include "host/images/images.h"

namespace kilolux {

struct ImageLibrary {
    decltype(&encode_pixels) encode;
    decltype(&open_writer) writer;
    decltype(&open_image) open_file;
    decltype(&open_encoded) open_bytes;
    decltype(&apply_ocio) ocio;
    decltype(&text_mask) text;
};

}  // namespace kilolux

extern "C" __attribute__((visibility("default"))) const kilolux::ImageLibrary kilolux_images;
