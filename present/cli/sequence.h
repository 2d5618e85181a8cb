// SPDX-License-Identifier: Apache-2.0
// Sequences: their frames, shards of them, and file names.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
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
    std::string_view variable{};  // of the environment, which says it; empty: none
    bool operator==(const Shard&) const = default;
};

/// Every `shard.count`-th of `items`, from that at `shard.index` on.
template <typename T>
std::vector<T> items_of_shard(const std::vector<T>& items, const Shard& shard) {
    std::vector<T> out;
    const auto step = static_cast<std::size_t>(shard.count);
    for (auto i = static_cast<std::size_t>(shard.index); i < items.size(); i += step)
        out.push_back(items[i]);
    return out;
}

/// Every `shard.count`-th of `numbers`, of frames or tiles, from that at `shard.index` on. Counted,
/// not stored.
class ShardNumbers {
 public:
    ShardNumbers(FrameList numbers, const Shard& shard);
    std::size_t size() const { return size_; }

    /// 0 <= i < size().
    int operator[](std::size_t i) const;

 private:
    FrameList numbers_;
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

/// Whether the file name holds a run of '#' that stands for the number of a frame or tile.
bool has_frame_pattern(const std::filesystem::path& file);

/// The file of one frame or tile: the last run of '#' in the file name becomes the number, padded
/// with zeros to the run's length and never cut.
std::filesystem::path numbered_file(const std::filesystem::path& pattern, int number);

/// The variables of one scheduler. Those that it does not set are null.
struct ArrayVariables {
    const char* scheduler;
    const char* index;
    const char* count;
    const char* first;  // the least index
    const char* step;   // between indices
    int base;           // the usual least index
};

/// Of a task one index is set.
inline constexpr auto kArrayVariables = std::to_array<ArrayVariables>({
    {"Slurm", "SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_ARRAY_TASK_MIN",
     "SLURM_ARRAY_TASK_STEP", 0},
    {"Kubernetes", "JOB_COMPLETION_INDEX", nullptr, nullptr, nullptr, 0},
    {"AWS Batch", "AWS_BATCH_JOB_ARRAY_INDEX", "AWS_BATCH_JOB_ARRAY_SIZE", nullptr, nullptr, 0},
    {"Open MPI", "OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", nullptr, nullptr, 0},
    {"GNU parallel", "PARALLEL_SEQ", nullptr, nullptr, nullptr, 1},
});

/// The help text of --shard; `parts` is what is divided, such as "frame or tile".
std::string shard_meaning(const std::string& parts);

/// Notes the variable that gave the shard, if there is one.
void note_shard(const Shard& shard);

/// This task's shard of as many as the scheduler has tasks. Throws UsageError that starts with
/// `option` where no index or several are set, or the scheduler does not tell the number.
Shard shard_of_task(const std::string& option);

/// This task's shard of `count`, where the scheduler's least index is the usual one: also right
/// where some tasks of an array are run again. Throws UsageError.
Shard shard_of_task(const std::string& option, int count);

}  // namespace kilolux
