// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/picture/bands.h"
#include "host/picture/frame.h"

namespace kilolux {

/// Pixels of a picture, from the left and the top.
struct PixelRect {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
    bool operator==(const PixelRect&) const = default;
};

/// Puts the pixels of `rect` that `rows` holds, whole rows of the picture, into `out`, a frame of
/// those pixels alone; adds the counts and times of `rows` to its.
void add_crop(Frame& out, const PixelRect& rect, const Frame& rows);

}  // namespace kilolux
