// SPDX-License-Identifier: Apache-2.0
#include "present/video/read_video.h"

#include <charconv>
#include <cstdio>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "host/base/error.h"
#include "host/base/system/child_process.h"
#include "host/base/text.h"
#include "present/video/video_file.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFrameMark = "FRAME\n";

VideoContents read_y4m(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    VideoContents out;
    constexpr std::size_t kLongestHeader = 256;
    out.header.resize(kLongestHeader);
    in.read(out.header.data(), kLongestHeader);
    out.header.resize(static_cast<std::size_t>(in.gcount()));
    const std::size_t end = out.header.find('\n');
    if (end == std::string::npos) throw Error(file.string() + ": holds no video");
    out.header.resize(end + 1);
    in.clear();
    if (std::sscanf(out.header.c_str(), "YUV4MPEG2 W%d H%d ", &out.width, &out.height) != 2 ||
        out.width <= 0 || out.height <= 0) {
        throw Error(file.string() + ": holds no video");
    }
    const std::uintmax_t pixels =
        static_cast<std::uintmax_t>(out.width) * static_cast<std::uintmax_t>(out.height);
    const std::uintmax_t frame_bytes = kFrameMark.size() + 3 * pixels;
    const std::uintmax_t bytes = fs::file_size(file) - out.header.size();
    out.is_whole = bytes % frame_bytes == 0;
    std::string mark(kFrameMark.size(), ' ');
    for (; out.frames < bytes / frame_bytes; ++out.frames) {
        in.seekg(static_cast<std::streamoff>(out.header.size() + out.frames * frame_bytes));
        in.read(mark.data(), static_cast<std::streamsize>(mark.size()));
        out.is_whole &= mark == kFrameMark;
    }
    return out;
}

// The value of a line NAME=VALUE of ffprobe; names of tags are upper case in some containers.
std::string value_of(const std::vector<std::string>& lines, const std::string& name) {
    for (const std::string& line : lines) {
        const std::size_t equals = line.find('=');
        if (lower(line.substr(0, equals)) == name) return line.substr(equals + 1);
    }
    return "";
}

VideoContents read_by_ffprobe(const fs::path& file) {
    ChildProcess ffprobe({"ffprobe", "-v", "error", "-count_packets", "-select_streams", "v:0",
                          "-show_entries", "stream=width,height,nb_read_packets:format_tags", "-of",
                          "default=noprint_wrappers=1", "file:" + fs::absolute(file).string()},
                         -1, fs::current_path(), true);
    const bool succeeded = ffprobe.succeeded();
    const std::vector<std::string> lines = ffprobe.messages();
    VideoContents out;
    const auto read = [&](const char* name, auto& number) {
        const std::string text = value_of(lines, name);
        return std::from_chars(text.data(), text.data() + text.size(), number).ec == std::errc();
    };
    if (!succeeded || !read("width", out.width) || !read("height", out.height) ||
        !read("nb_read_packets", out.frames)) {
        throw Error(file.string() + ": holds no video");
    }
    out.note = value_of(lines, "tag:comment");
    return out;
}

}  // namespace

void check_can_read_video(const fs::path& file) {
    if (is_y4m(file) || has_program("ffprobe")) return;
    throw Error(file.string() +
                ": ffprobe, which says what a video holds, not found; install the package ffmpeg, "
                "or leave --skip-existing out");
}

VideoContents read_video(const fs::path& file) {
    return is_y4m(file) ? read_y4m(file) : read_by_ffprobe(file);
}

}  // namespace kilolux
