// SPDX-License-Identifier: Apache-2.0
#include "present/cli/sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "host/base/error.h"

namespace kilolux {

std::size_t FrameRange::size() const {
    return static_cast<std::size_t>((std::int64_t{last} - first) / step) + 1;
}

FrameList::FrameList(FrameRange range) : FrameList(std::vector{range}) {}

FrameList::FrameList(std::vector<FrameRange> ranges) : ranges_(std::move(ranges)) {
    std::size_t end = 0;
    for (std::size_t i = 0; i < ranges_.size(); ++i) {
        if (i > 0 && ranges_[i].first <= ranges_[i - 1].last) {
            throw Error(
                fmt::format("frame {} comes after {}", ranges_[i].first, ranges_[i - 1].last));
        }
        ends_.push_back(end += ranges_[i].size());
    }
}

int FrameList::operator[](std::size_t i) const {
    const auto range =
        static_cast<std::size_t>(std::upper_bound(ends_.begin(), ends_.end(), i) - ends_.begin());
    const std::size_t before = range == 0 ? 0 : ends_[range - 1];
    return ranges_[range].first + static_cast<int>(i - before) * ranges_[range].step;
}

ShardFrames::ShardFrames(FrameList frames, const Shard& shard)
    : frames_(std::move(frames)),
      index_(static_cast<std::size_t>(shard.index)),
      count_(static_cast<std::size_t>(shard.count)),
      size_(index_ < frames_.size() ? (frames_.size() - 1 - index_) / count_ + 1 : 0) {}

int ShardFrames::operator[](std::size_t i) const { return frames_[index_ + i * count_]; }

PixelRect tile_rect(const TileGrid& tiles, int tile, int width, int height) {
    const auto edge = [](int pixels, int place, int count) {
        return static_cast<int>(std::int64_t{pixels} * place / count);
    };
    const int column = tile % tiles.columns, row = tile / tiles.columns;
    const int x = edge(width, column, tiles.columns), y = edge(height, row, tiles.rows);
    return {x, y, edge(width, column + 1, tiles.columns) - x,
            edge(height, row + 1, tiles.rows) - y};
}

bool has_frame_pattern(const std::filesystem::path& file) {
    return file.filename().string().find('#') != std::string::npos;
}

std::filesystem::path frame_file(const std::filesystem::path& pattern, int frame) {
    std::string name = pattern.filename().string();
    const std::size_t last = name.find_last_of('#');
    if (last == std::string::npos) return pattern;
    const std::size_t before = name.find_last_not_of('#', last);
    const std::size_t first = before == std::string::npos ? 0 : before + 1;
    const std::size_t width = last - first + 1;
    name.replace(first, width, fmt::format("{:0{}}", frame, width));
    return pattern.parent_path() / name;
}

}  // namespace kilolux
