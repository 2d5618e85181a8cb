// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/picture/decoded_surfaces.h"
#include "host/picture/frame.h"

namespace kilolux {

/// Appends the rows of a band to the picture's; `size` is the whole's.
template <typename T>
void append_rows(std::vector<T>& whole, std::vector<T>&& rows, std::size_t size) {
    if (whole.empty() && rows.size() == size) {
        whole = std::move(rows);
        return;
    }
    if (rows.empty()) return;
    whole.reserve(size);
    whole.insert(whole.end(), rows.begin(), rows.end());
}

/// Appends a band's layers, which are the same in every band, to the picture's.
void append_layers(std::vector<Layer>& whole, std::vector<Layer>&& band, std::size_t pixels);

/// Puts the rows of a band into the picture's surfaces, of `height` rows.
void place_surfaces(DecodedSurfaces& whole, DecodedSurfaces&& band, int height);

/// Adds the counts of a band's lists to those of the bands above. Values that do not depend on the
/// band are set; means are weighted by the pixels with a surface.
void add_band(FrameStats& whole, const FrameStats& band);

}  // namespace kilolux
