// SPDX-License-Identifier: Apache-2.0
#include "present/cli/sequence.h"

#include <fmt/format.h>

#include <string>

namespace kilolux {

ShardFrames::ShardFrames(const FrameRange& range, const Shard& shard)
    : first_(std::int64_t{range.first} + shard.index), step_(shard.count) {
    size_ = first_ > range.last ? 0 : static_cast<std::size_t>((range.last - first_) / step_ + 1);
}

int ShardFrames::operator[](std::size_t i) const {
    return static_cast<int>(first_ + static_cast<std::int64_t>(i) * step_);
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
