// SPDX-License-Identifier: Apache-2.0
// Sequences: which frames there are, which of them are ours, and what their files are called.
#pragma once

#include <filesystem>
#include <vector>

namespace kilolux {

/// Frames first to last, both included.
struct FrameRange {
    int first = 0;
    int last = 0;
};

/// Part `index` of `count` of a sequence, so that any batch scheduler can spread it.
struct Shard {
    int index = 0;  // 0 <= index < count
    int count = 1;
};

/// Frames f of `range` with (f - range.first) % shard.count == shard.index, ascending.
std::vector<int> frames_of_shard(const FrameRange& range, const Shard& shard);

/// Whether the file name holds a run of '#' that stands for the frame number.
bool has_frame_pattern(const std::filesystem::path& file);

/// The file of one frame: the last run of '#' in the file name becomes the number, padded with
/// zeros to the run's length and never cut.
std::filesystem::path frame_file(const std::filesystem::path& pattern, int frame);

}  // namespace kilolux
