// SPDX-License-Identifier: Apache-2.0
// Sequences: their frames, shards of them, and file names.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace kilolux {

/// Frames first to last, both included.
struct FrameRange {
    int first = 0;
    int last = 0;
    bool operator==(const FrameRange&) const = default;
};

/// Part `index` of `count` of a sequence, so that any batch scheduler can spread it.
struct Shard {
    int index = 0;  // 0 <= index < count
    int count = 1;
    bool operator==(const Shard&) const = default;
};

/// Frames f of `range` with (f - range.first) % shard.count == shard.index, ascending. Counted, not
/// stored.
class ShardFrames {
 public:
    ShardFrames(const FrameRange& range, const Shard& shard);
    std::size_t size() const { return size_; }

    /// 0 <= i < size().
    int operator[](std::size_t i) const;

 private:
    std::int64_t first_;
    std::int64_t step_;
    std::size_t size_;
};

/// Whether the file name holds a run of '#' that stands for the frame number.
bool has_frame_pattern(const std::filesystem::path& file);

/// The file of one frame: the last run of '#' in the file name becomes the number, padded with
/// zeros to the run's length and never cut.
std::filesystem::path frame_file(const std::filesystem::path& pattern, int frame);

}  // namespace kilolux
