// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "host/picture/decoded_surfaces.h"
#include "host/picture/frame.h"

namespace kilolux {

/// Puts a band's layers, which are the same in every band, into the picture's: from pixel `first`
/// on, of `pixels`.
void place_layers(std::vector<Layer>& whole, std::vector<Layer>&& band, std::size_t first,
                  std::size_t pixels);

/// Puts the rows of a band into the picture's surfaces, of `height` rows.
void place_surfaces(DecodedSurfaces& whole, DecodedSurfaces&& band, int height);

/// Adds the counts of a band's lists to those of the bands above. Values that do not depend on the
/// band are set; means are weighted by the pixels with a surface.
void add_band(FrameStats& whole, const FrameStats& band);

/// Adds what the same renderer counted and measured for further rows of its picture.
void add_rows(FrameStats& whole, const FrameStats& rows);

/// The counts of a picture that several renderers made, each its rows, with the times of the one
/// that took longest.
FrameStats joined(const std::vector<FrameStats>& parts);

}  // namespace kilolux
