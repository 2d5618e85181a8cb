// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/spares.h"
#include "present/video/y4m.h"

namespace kilolux {

/// The extensions of videos.
std::vector<std::string> video_extensions();

/// Whether the output is a video: by its extension, or "-", y4m on standard output.
bool is_video(const std::filesystem::path& file);

/// Whether the video is written here, without ffmpeg.
bool is_y4m(const std::filesystem::path& file);

/// "standard output" for "-", else the file.
std::string output_name(const std::filesystem::path& file);

/// Throws UsageError for a size that the video's encoder does not take.
void check_video_size(const std::filesystem::path& file, int width, int height);

/// Throws Error if the video certainly cannot be made: no such folder, no permission, no ffmpeg,
/// or standard output is a terminal. Asked before work whose result would be lost.
void check_can_write_video(const std::filesystem::path& file);

/// A video that is written frame by frame. Without commit() a file stays as it was; standard output
/// holds whole frames. .y4m is written here, other types by the program ffmpeg, H.264 (.mp4, .mkv)
/// or VP9 (.webm) with chroma of half the size (4:2:0).
class VideoFile {
 public:
    /// Throws Error when the file cannot be made or ffmpeg cannot be run. `note`: the file's
    /// comment; of .y4m its hash is.
    VideoFile(const std::filesystem::path& file, const VideoFormat& format,
              const std::string& note = {});
    ~VideoFile();
    VideoFile(const VideoFile&) = delete;
    VideoFile& operator=(const VideoFile&) = delete;

    /// Appends a y4m_frame(). Throws Error with the system's or ffmpeg's reason.
    void write(std::string_view frame);

    /// Of y4m_frame(), for further ones.
    Spares<std::string>& spares() { return spares_; }

    /// Ends the video and puts it in its place.
    void commit();

    /// Where the bytes of a stream go.
    class Sink;

 private:
    std::unique_ptr<Sink> sink_;
    std::string header_;  // until it is written
    Spares<std::string> spares_;
};

}  // namespace kilolux
