// SPDX-License-Identifier: Apache-2.0
#include "present/commands/assemble/tiles.h"

#include <fmt/format.h>
#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "host/base/error.h"
#include "host/render/settings.h"
#include "present/cli/option_values.h"
#include "present/image/image_file.h"
#include "present/image/image_notes.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

struct Tile {
    fs::path file;
    ImageLayout layout;
    PixelRect place;
    std::pair<int, int> whole{};           // size of the picture
    std::string crop{};                    // " --crop X,Y,W,H"
    std::string command{};                 // of its note, without that
    std::string time{};                    // of its note
    std::unique_ptr<ImageReader> image{};  // while its rows are read
};

// A note of a file, as `parse` reads it.
template <typename Parse>
auto parsed_note(const Tile& tile, const std::string& name, const Parse& parse) {
    const std::string text = note_in(tile.file, tile.layout, name);
    if (text.empty()) {
        throw Error(fmt::format("{}: has no note of a --{}, so its place is unknown",
                                tile.file.string(), name));
    }
    try {
        return parse("--" + name, text);
    } catch (const UsageError& error) {
        throw Error(fmt::format("{}: a note is broken: {}", tile.file.string(), error.what()));
    }
}

Tile find_tile(const fs::path& file) {
    Tile out{file, open_image(file)->layout(), {}};
    out.command = note_in(file, out.layout, "command");
    out.time = note_in(file, out.layout, "time");
    out.place = parsed_note(out, "crop", parse_crop);
    out.whole = parsed_note(out, "resolution", parse_resolution);
    drop_note(out.layout, "crop");
    out.crop = " --crop " + text_of(out.place);
    const std::size_t at = out.command.find(out.crop);
    if (at != std::string::npos) out.command.erase(at, out.crop.size());
    if (out.place.width == out.layout.width && out.place.height == out.layout.height) return out;
    throw Error(fmt::format("{}: has {}x{} pixels, and its note is{}", file.string(),
                            out.layout.width, out.layout.height, out.crop));
}

bool is_alike(const ImageChannel& a, const ImageChannel& b) {
    return a.name == b.name && a.type == b.type;
}

// Throws where a tile is of another picture than the first one.
void require_one_picture(const std::vector<Tile>& tiles) {
    const Tile& first = tiles.front();
    for (const Tile& tile : tiles) {
        const std::string both = tile.file.string() + " and " + first.file.string() + ": ";
        if (tile.command != first.command || tile.time != first.time) {
            throw Error(fmt::format("{}are of other pictures: '{}' at {} and '{}' at {}", both,
                                    tile.command, tile.time, first.command, first.time));
        }
        if (!std::ranges::equal(tile.layout.channels, first.layout.channels, is_alike)) {
            throw Error(both + "have other channels");
        }
    }
}

// Tiles beside each other, from the left.
using TileRow = std::vector<Tile>;

// Sorts the tiles into rows that fill a rectangle.
std::vector<TileRow> rows_of(std::vector<Tile> tiles) {
    std::ranges::sort(tiles, {}, [](const Tile& t) { return std::pair(t.place.y, t.place.x); });
    std::vector<TileRow> out;
    int x = 0, y = 0;
    for (Tile& tile : tiles) {
        const PixelRect place = tile.place;
        if (out.empty() || place.y != out.back().front().place.y) {
            y = out.empty() ? 0 : y + out.back().front().place.height;
            x = 0;
            out.emplace_back();
        }
        const bool is_next = place.x == x && place.y == y;
        if (!is_next || (!out.back().empty() && place.height != out.back().front().place.height)) {
            throw Error(fmt::format("{}: is at{}; the tiles before it end at {},{}",
                                    tile.file.string(), tile.crop, x, y));
        }
        x += place.width;
        out.back().push_back(std::move(tile));
    }
    const auto width_of = [](const TileRow& row) {
        return row.back().place.x + row.back().place.width;
    };
    for (const TileRow& row : out) {
        if (width_of(row) == width_of(out.front())) continue;
        throw Error(fmt::format("{}: its row of tiles is {} pixels wide, the first {}",
                                row.back().file.string(), width_of(row), width_of(out.front())));
    }
    return out;
}

// Reads rows [begin, end) of the picture to `pixels`.
void read_rows(std::vector<TileRow>& rows, int begin, int end, std::size_t pixel_bytes,
               std::size_t stride, std::vector<unsigned char>& pixels) {
    for (TileRow& row : rows) {
        const PixelRect& first = row.front().place;
        const int from = std::max(begin, first.y), to = std::min(end, first.y + first.height);
        if (from >= to) continue;
        for (Tile& tile : row) {
            if (!tile.image) tile.image = open_image(tile.file);
            const std::size_t at = stride * static_cast<std::size_t>(from - begin) +
                                   pixel_bytes * static_cast<std::size_t>(tile.place.x);
            tile.image->read_rows(from - first.y, to - from, &pixels[at], stride);
            if (to == first.y + first.height) tile.image.reset();
        }
    }
}

}  // namespace

void join_tiles(const fs::path& out, const std::vector<fs::path>& tiles,
                const std::function<void(double)>& on_rows) {
    std::vector<Tile> opened;
    for (const fs::path& file : tiles) {
        if (!share_lossless_format(out, file)) {
            throw Error(
                fmt::format("{}: tiles of {} cannot be joined without loss; both must be "
                            ".exr, .png or .tif",
                            out.string(), file.string()));
        }
        opened.push_back(find_tile(file));
    }
    require_one_picture(opened);
    std::vector<TileRow> rows = rows_of(std::move(opened));
    const Tile& first = rows.front().front();
    const PixelRect& last = rows.back().back().place;
    const auto [width, height] = first.whole;
    if (last.x + last.width != width || last.y + last.height != height) {
        throw Error(
            fmt::format("{}: is the last tile and ends at {},{}; the picture has {}x{} pixels",
                        rows.back().back().file.string(), last.x + last.width, last.y + last.height,
                        width, height));
    }
    const ImageLayout layout = layout_of_whole(out, first.layout, width, height, first.crop);
    const std::size_t pixel_bytes = layout.pixel_bytes();
    const std::size_t stride = pixel_bytes * static_cast<std::size_t>(layout.width);
    constexpr int kRows = 8 * kFileBlockRows;
    ImageStream file(out);
    for (int y = 0; y < height; y += kRows) {
        FileRows part{layout, std::min(kRows, height - y)};
        part.own.resize(stride * static_cast<std::size_t>(part.rows));
        read_rows(rows, y, y + part.rows, pixel_bytes, stride, part.own);
        part.pixels = part.own;
        part.pixel_stride = pixel_bytes;
        file.write(part);
        on_rows(static_cast<double>(y + part.rows) / height);
    }
    file.commit();
}

}  // namespace kilolux
