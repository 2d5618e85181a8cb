// SPDX-License-Identifier: Apache-2.0
#include "host/picture/crop.h"

#include <algorithm>
#include <vector>

#include "host/picture/frame_bands.h"

namespace kilolux {
namespace {

// Rows of the picture, of `width` pixels, and those of them that are asked for.
struct RowsToCut {
    PixelRect rect;
    int width = 0;
    int first_row = 0;
    int rows = 0;
};

template <typename T>
void copy_pixels(std::vector<T>& out, const std::vector<T>& from, std::size_t values,
                 const RowsToCut& cut) {
    if (from.empty()) return;
    const PixelRect& rect = cut.rect;
    const auto row = values * static_cast<std::size_t>(rect.width);
    out.resize(row * static_cast<std::size_t>(rect.height));
    const int end = std::min(cut.first_row + cut.rows, rect.y + rect.height);
    for (int y = std::max(cut.first_row, rect.y); y < end; ++y) {
        const auto begin =
            (static_cast<std::size_t>(y - cut.first_row) * static_cast<std::size_t>(cut.width) +
             static_cast<std::size_t>(rect.x)) *
            values;
        std::copy_n(
            from.begin() + static_cast<std::ptrdiff_t>(begin), row,
            out.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y - rect.y) * row));
    }
}

}  // namespace

void add_crop(Frame& out, const PixelRect& rect, const Frame& rows) {
    const RowsToCut cut{rect, rows.width, rows.first_row, rows.height};
    const bool is_first = out.width == 0;
    out.width = rect.width;
    out.height = rect.height;
    copy_pixels(out.radiance, rows.radiance, 3, cut);
    copy_pixels(out.shown_light, rows.shown_light, 3, cut);
    copy_pixels(out.display, rows.display, 4, cut);
    out.aovs.resize(rows.aovs.size());
    for (std::size_t i = 0; i < rows.aovs.size(); ++i) {
        const Layer& from = rows.aovs[i];
        Layer& layer = out.aovs[i];
        layer.name = from.name;
        layer.channels = from.channels;
        layer.most_id = std::max(layer.most_id, from.most_id);
        copy_pixels(layer.values, from.values, from.channels.size(), cut);
        copy_pixels(layer.ids, from.ids, from.channels.size(), cut);
    }
    if (is_first) {
        out.stats = rows.stats;
    } else {
        add_rows(out.stats, rows.stats);
    }
}

}  // namespace kilolux
