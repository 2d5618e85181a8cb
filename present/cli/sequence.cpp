// SPDX-License-Identifier: Apache-2.0
#include "present/cli/sequence.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/text.h"
#include "present/cli/option_values.h"

namespace kilolux {
namespace {

bool is_set(const char* variable) {
    const char* text = std::getenv(variable);
    return text != nullptr && *text != '\0';
}

const ArrayVariables& variables_of_task(const std::string& option) {
    const ArrayVariables* found = nullptr;
    std::vector<std::string> names;
    for (const ArrayVariables& row : kArrayVariables) {
        names.emplace_back(row.index);
        if (!is_set(row.index)) continue;
        // A task that starts others hands its variables down: all would take its shard.
        if (found != nullptr) {
            throw UsageError(fmt::format("{} auto: both {} and {} are set; name the shard as I/N",
                                         option, found->index, row.index));
        }
        found = &row;
    }
    if (found != nullptr) return *found;
    throw UsageError(fmt::format("{} auto: the environment has none of {}; name the shard as I/N",
                                 option, joined(names)));
}

// A whole number of the environment.
int number_in(const std::string& option, const char* variable) {
    const char* text = std::getenv(variable);
    if (!is_set(variable)) {
        throw UsageError(fmt::format("{} auto: the environment lacks {}", option, variable));
    }
    const auto number = count_of(text);
    if (number && *number <= std::numeric_limits<int>::max()) return static_cast<int>(*number);
    throw UsageError(
        fmt::format("{} auto: {} is '{}', no whole number from 0 on", option, variable, text));
}

// Of `count` tasks with indices from `first` on.
Shard checked_shard(const std::string& option, const ArrayVariables& row, std::int64_t place,
                    int count, int first) {
    if (place >= 0 && place < count) return {static_cast<int>(place), count, row.index};
    throw UsageError(fmt::format("{} auto: {} is {}, which is none of {} tasks from {} on", option,
                                 row.index, std::getenv(row.index), count, first));
}

}  // namespace

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

ShardNumbers::ShardNumbers(FrameList numbers, const Shard& shard)
    : numbers_(std::move(numbers)),
      index_(static_cast<std::size_t>(shard.index)),
      count_(static_cast<std::size_t>(shard.count)),
      size_(index_ < numbers_.size() ? (numbers_.size() - 1 - index_) / count_ + 1 : 0) {}

int ShardNumbers::operator[](std::size_t i) const { return numbers_[index_ + i * count_]; }

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

std::filesystem::path numbered_file(const std::filesystem::path& pattern, int number) {
    std::string name = pattern.filename().string();
    const std::size_t last = name.find_last_of('#');
    if (last == std::string::npos) return pattern;
    const std::size_t before = name.find_last_not_of('#', last);
    const std::size_t first = before == std::string::npos ? 0 : before + 1;
    const std::size_t width = last - first + 1;
    name.replace(first, width, fmt::format("{:0{}}", number, width));
    return pattern.parent_path() / name;
}

std::string shard_meaning(const std::string& parts) {
    std::vector<std::string> names;
    for (const ArrayVariables& row : kArrayVariables) names.emplace_back(row.scheduler);
    return fmt::format(
        "Every N-th {} from the I-th on, counted from 0. auto takes I and N from the variables of "
        "{}; auto/N takes only I",
        parts, joined(names));
}

void note_shard(const Shard& shard) {
    if (!shard.variable.empty())
        note(fmt::format("shard {} by {}", text_of(shard), shard.variable));
}

Shard shard_of_task(const std::string& option) {
    const ArrayVariables& row = variables_of_task(option);
    if (row.count == nullptr) {
        throw UsageError(
            fmt::format("{} auto: {} does not tell how many tasks there are; write auto/N", option,
                        row.scheduler));
    }
    const int count = number_in(option, row.count);
    const int first = row.first == nullptr ? row.base : number_in(option, row.first);
    const int step = row.step == nullptr ? 1 : number_in(option, row.step);
    const std::int64_t place = std::int64_t{number_in(option, row.index)} - first;
    if (step < 1 || place % step != 0) {
        throw UsageError(fmt::format("{} auto: {}'s array is no range of indices; write auto/N",
                                     option, row.scheduler));
    }
    return checked_shard(option, row, place / step, count, first);
}

Shard shard_of_task(const std::string& option, int count) {
    const ArrayVariables& row = variables_of_task(option);
    const std::int64_t place = std::int64_t{number_in(option, row.index)} - row.base;
    return checked_shard(option, row, place, count, row.base);
}

}  // namespace kilolux
