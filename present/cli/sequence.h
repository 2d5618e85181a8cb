// SPDX-License-Identifier: Apache-2.0
// Sequences: their frames, shards of them, and file names.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "host/picture/crop.h"

namespace kilolux {

/// Frames first, first + step, ... up to last, which is one of them.
struct FrameRange {
    int first = 0;
    int last = 0;
    int step = 1;
    std::size_t size() const;
    bool operator==(const FrameRange&) const = default;
};

/// Frames in ascending order. Counted, not stored.
class FrameList {
 public:
    FrameList(FrameRange range);  // NOLINT: a range is a list

    /// Throws Error "frame 7 comes after 9" unless the ranges, at least one, ascend.
    explicit FrameList(std::vector<FrameRange> ranges);

    const std::vector<FrameRange>& ranges() const { return ranges_; }
    int first() const { return ranges_.front().first; }
    int last() const { return ranges_.back().last; }
    std::size_t size() const { return ends_.back(); }

    /// 0 <= i < size().
    int operator[](std::size_t i) const;
    bool operator==(const FrameList&) const = default;

 private:
    std::vector<FrameRange> ranges_;
    std::vector<std::size_t> ends_;  // frames up to each range's end
};

/// Part `index` of `count` of a sequence, so that any batch scheduler can spread it.
struct Shard {
    int index = 0;  // 0 <= index < count
    int count = 1;
    std::string_view variable{};  // of the environment, which told it; empty: none
    bool operator==(const Shard&) const = default;
};

/// Every `shard.count`-th of `items`, from that at `shard.index` on.
template <typename T>
std::vector<T> part_of(const std::vector<T>& items, const Shard& shard) {
    std::vector<T> out;
    const auto step = static_cast<std::size_t>(shard.count);
    for (auto i = static_cast<std::size_t>(shard.index); i < items.size(); i += step)
        out.push_back(items[i]);
    return out;
}

/// Every `shard.count`-th of `frames`, from that at `shard.index` on. Counted, not stored.
class ShardFrames {
 public:
    ShardFrames(FrameList frames, const Shard& shard);
    std::size_t size() const { return size_; }

    /// 0 <= i < size().
    int operator[](std::size_t i) const;

 private:
    FrameList frames_;
    std::size_t index_;
    std::size_t count_;
    std::size_t size_;
};

/// A picture's parts, `columns` beside each other and `rows` of them.
struct TileGrid {
    int columns = 1;
    int rows = 1;
    bool operator==(const TileGrid&) const = default;
};

/// The pixels of a tile of a picture; tiles are counted from the left in each row, from the top.
PixelRect tile_rect(const TileGrid& tiles, int tile, int width, int height);

/// Whether the file name holds a run of '#' that stands for the frame number.
bool has_frame_pattern(const std::filesystem::path& file);

/// The file of one frame: the last run of '#' in the file name becomes the number, padded with
/// zeros to the run's length and never cut.
std::filesystem::path frame_file(const std::filesystem::path& pattern, int frame);

}  // namespace kilolux
