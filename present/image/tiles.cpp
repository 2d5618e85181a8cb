// SPDX-License-Identifier: Apache-2.0
#include "present/image/tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "host/base/error.h"
#include "host/base/text.h"
#include "present/image/image_file.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

struct Tile {
    fs::path file;
    std::unique_ptr<ImageReader> image;
    PixelRect place;
    std::string crop;     // " --crop X,Y,W,H" of its note
    std::string command;  // of its note, without that
    const ImageLayout& layout() const { return image->layout(); }
};

constexpr const char* kCrop = " --crop ";

Tile open_tile(const fs::path& file) {
    Tile out{file, open_image(file), {}, "", ""};
    out.command = note_in(file, out.layout(), "command");
    const std::size_t at = out.command.find(kCrop);
    if (at == std::string::npos) {
        throw Error(file.string() + ": has no note of a --crop, so its place is unknown");
    }
    const std::size_t end = std::min(out.command.find(' ', at + 8), out.command.size());
    out.crop = out.command.substr(at, end - at);
    out.command.erase(at, end - at);
    std::vector<int> numbers;
    const std::string text = out.crop.substr(8);
    for (const std::string_view part : split(text, ',')) {
        numbers.push_back(static_cast<int>(count_of(part).value_or(0)));
    }
    numbers.resize(4);
    out.place = {numbers[0], numbers[1], numbers[2], numbers[3]};
    if (out.place.width == out.layout().width && out.place.height == out.layout().height)
        return out;
    throw Error(fmt::format("{}: has {}x{} pixels, and its note is{}", file.string(),
                            out.layout().width, out.layout().height, out.crop));
}

bool is_alike(const ImageChannel& a, const ImageChannel& b) {
    return a.name == b.name && a.type == b.type;
}

// Throws where a tile is of another picture than the first one.
void require_one_picture(const std::vector<Tile>& tiles) {
    const Tile& first = tiles.front();
    for (const Tile& tile : tiles) {
        const std::string both = tile.file.string() + " and " + first.file.string() + ": ";
        if (tile.command != first.command) {
            throw Error(fmt::format("{}are of other pictures: '{}' and '{}'", both, tile.command,
                                    first.command));
        }
        if (!std::ranges::equal(tile.layout().channels, first.layout().channels, is_alike)) {
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

void write_row(ImageStream& out, const ImageLayout& layout, const TileRow& row,
               const std::function<void(int)>& on_rows) {
    constexpr int kRows = 8 * kFileBlockRows;
    const std::size_t pixel = layout.pixel_bytes();
    const std::size_t stride = pixel * static_cast<std::size_t>(layout.width);
    const int height = row.front().place.height;
    for (int y = 0; y < height; y += kRows) {
        FileRows part{layout, std::min(kRows, height - y)};
        part.own.resize(stride * static_cast<std::size_t>(part.rows));
        for (const Tile& tile : row) {
            tile.image->read_rows(
                y, part.rows, &part.own[pixel * static_cast<std::size_t>(tile.place.x)], stride);
        }
        part.pixels = part.own;
        part.pixel_stride = pixel;
        out.write(part);
        on_rows(part.rows);
    }
}

}  // namespace

void join_tiles(const fs::path& out, const std::vector<fs::path>& tiles,
                const std::function<void(double)>& on_rows) {
    std::vector<Tile> opened;
    for (const fs::path& file : tiles) {
        if (!are_of_lossless_format(out, file)) {
            throw Error(
                fmt::format("{}: tiles of {} cannot be joined without loss; both must be "
                            ".exr, .png or .tif",
                            out.string(), file.string()));
        }
        opened.push_back(open_tile(file));
    }
    require_one_picture(opened);
    const std::vector<TileRow> rows = rows_of(std::move(opened));
    const Tile& first = rows.front().front();
    const PixelRect& last = rows.back().back().place;
    const int height = last.y + last.height;
    const ImageLayout layout =
        layout_of_whole(out, first.layout(), last.x + last.width, height, first.crop);
    ImageStream file(out);
    int done = 0;
    for (const TileRow& row : rows) {
        write_row(file, layout, row, [&](int count) {
            done += count;
            on_rows(static_cast<double>(done) / height);
        });
    }
    file.commit();
}

}  // namespace kilolux
