// SPDX-License-Identifier: Apache-2.0
#include "present/cli/sequence.h"

#include <cstdint>
#include <string>

namespace kilolux {

std::vector<int> frames_of_shard(const FrameRange& range, const Shard& shard) {
    std::vector<int> frames;
    for (std::int64_t frame = std::int64_t{range.first} + shard.index; frame <= range.last;
         frame += shard.count) {
        frames.push_back(static_cast<int>(frame));
    }
    return frames;
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
    std::string number = std::to_string(frame);
    if (number.size() < width) number.insert(0, width - number.size(), '0');
    name.replace(first, width, number);
    return pattern.parent_path() / name;
}

}  // namespace kilolux
