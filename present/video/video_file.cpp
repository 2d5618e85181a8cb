// SPDX-License-Identifier: Apache-2.0
#include "present/video/video_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <optional>
#include <string_view>
#include <utility>

#include "host/base/error.h"
#include "host/base/system/atomic_write.h"
#include "host/base/system/child_process.h"
#include "host/base/system/descriptor.h"
#include "host/base/text.h"

namespace kilolux {

namespace fs = std::filesystem;

class VideoFile::Sink {
 public:
    Sink() = default;
    virtual ~Sink() = default;
    Sink(const Sink&) = delete;
    Sink& operator=(const Sink&) = delete;
    virtual void write(std::string_view bytes) = 0;
    virtual void commit() = 0;
};

namespace {

struct Encoder {
    const char* extension;
    const char* muxer;  // ffmpeg's name; nullptr: y4m, written here
    bool even_size;
    std::vector<std::string> options;
};

const std::vector<Encoder>& encoders() {
    // Constant quality at which the loss is hard to see (18 of x264, 24 of VP9). Players start an
    // mp4 before they have all of it when its index comes first.
    static const std::vector<std::string> h264 = {"-c:v", "libx264", "-crf", "18"};
    static const std::vector<std::string> mp4 = {"-c:v", "libx264",   "-crf",
                                                 "18",   "-movflags", "+faststart"};
    static const std::vector<std::string> vp9 = {"-c:v", "libvpx-vp9", "-crf",    "24",
                                                 "-b:v", "0",          "-row-mt", "1"};
    static const std::vector<Encoder> all = {{".y4m", nullptr, false, {}},
                                             {".mp4", "mp4", true, mp4},
                                             {".mkv", "matroska", true, h264},
                                             {".webm", "webm", false, vp9}};
    return all;
}

bool is_standard_output(const fs::path& file) { return file == "-"; }

// nullptr for what is no video.
const Encoder* encoder_of(const fs::path& file) {
    const std::string extension =
        is_standard_output(file) ? ".y4m" : lower(file.extension().string());
    for (const Encoder& encoder : encoders()) {
        if (extension == encoder.extension) return &encoder;
    }
    return nullptr;
}

class FileSink : public VideoFile::Sink {
 public:
    explicit FileSink(const fs::path& file) : file_(file) {}
    void write(std::string_view bytes) override {
        file_.write(bytes);
        begin_flush(file_.descriptor());
    }
    void commit() override { file_.commit(); }

 private:
    AtomicFile file_;
};

class StandardOutputSink : public VideoFile::Sink {
 public:
    StandardOutputSink() : out_(::dup(STDOUT_FILENO), output_name("-")) {}
    void write(std::string_view bytes) override { out_.write_all(bytes); }
    void commit() override { out_.finish(); }

 private:
    Descriptor out_;
};

// Colours as the stream has them: BT.709's matrix and primaries, sRGB's curve, limited range.
std::vector<std::string> ffmpeg_words(const Encoder& encoder, const fs::path& file,
                                      const std::string& note) {
    std::vector<std::string> words = {
        "ffmpeg", "-hide_banner", "-nostdin", "-loglevel", "error", "-y", "-f", "yuv4mpegpipe",
        // Of the input, then of the output: only chroma is scaled.
        "-colorspace", "bt709", "-color_range", "tv", "-i", "pipe:0", "-vf",
        ("scale=in_color_matrix=bt709:out_color_matrix=bt709:in_range=tv:out_range=tv,"
         "format=yuv420p"),
        "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1",
        "-color_range", "tv", "-chroma_sample_location", "left",
        // The same pictures give the same bytes.
        "-fflags", "+bitexact", "-flags:v", "+bitexact"};
    words.insert(words.end(), encoder.options.begin(), encoder.options.end());
    if (!note.empty()) words.insert(words.end(), {"-metadata", "comment=" + note});
    // With "file:" a name with a colon is no protocol and one with a dash no option.
    words.insert(words.end(), {"-f", encoder.muxer, "file:" + file.string()});
    return words;
}

struct Pipe {
    std::optional<Descriptor> read, write;
    explicit Pipe(const fs::path& file) {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) fail_to_write(file);
        read.emplace(ends[0], file);
        write.emplace(ends[1], file);
    }
};

// The program ffmpeg writes the temporary file that commit() renames.
class FfmpegSink : public VideoFile::Sink {
 public:
    FfmpegSink(const Encoder& encoder, const fs::path& file, const std::string& note)
        : name_(file.string()),
          file_(file),
          pipe_(file),
          process_(ffmpeg_words(encoder, fs::absolute(file_.path()), note), pipe_.read->get()) {
        pipe_.read.reset();
    }

    void write(std::string_view bytes) override {
        try {
            pipe_.write->write_all(bytes);
        } catch (const Error&) {  // it has closed its input: its own reason says more
            fail();
        }
    }

    void commit() override {
        pipe_.write.reset();
        if (!process_.succeeded()) fail_ended();
        file_.commit();
    }

 private:
    [[noreturn]] void fail() {
        pipe_.write.reset();
        process_.succeeded();
        fail_ended();
    }

    [[noreturn]] void fail_ended() const {
        const std::vector<std::string> lines = process_.messages();
        throw Error(name_ + ": ffmpeg failed: " + (lines.empty() ? "it says nothing" : lines[0]));
    }

    std::string name_;
    AtomicFile file_;
    Pipe pipe_;
    ChildProcess process_;  // ends before its file goes
};

std::unique_ptr<VideoFile::Sink> make_sink(const fs::path& file, const std::string& note) {
    if (is_standard_output(file)) return std::make_unique<StandardOutputSink>();
    const Encoder& encoder = *encoder_of(file);
    if (encoder.muxer == nullptr) return std::make_unique<FileSink>(file);
    return std::make_unique<FfmpegSink>(encoder, file, note);
}

}  // namespace

std::vector<std::string> video_extensions() {
    std::vector<std::string> out;
    for (const Encoder& encoder : encoders()) out.emplace_back(encoder.extension);
    return out;
}

bool is_y4m(const fs::path& file) { return is_video(file) && encoder_of(file)->muxer == nullptr; }

bool is_video(const fs::path& file) { return encoder_of(file) != nullptr; }

std::string output_name(const fs::path& file) {
    return is_standard_output(file) ? "standard output" : file.string();
}

void check_video_size(const fs::path& file, int width, int height) {
    if (!encoder_of(file)->even_size || (width % 2 == 0 && height % 2 == 0)) return;
    throw UsageError(fmt::format(
        "--resolution: {}x{}: H.264 with 4:2:0 needs an even width and height; or write .webm or "
        ".y4m",
        width, height));
}

void check_can_write_video(const fs::path& file) {
    if (is_standard_output(file)) {
        if (::isatty(STDOUT_FILENO) == 1) {
            throw Error("standard output: is a terminal; pipe the video: ... -o - | mpv -");
        }
        return;
    }
    check_can_write(file);
    if (encoder_of(file)->muxer != nullptr && !has_program("ffmpeg")) {
        throw Error(file.string() +
                    ": ffmpeg not found; install the package ffmpeg, or write .y4m");
    }
}

VideoFile::VideoFile(const fs::path& file, const VideoFormat& format, const std::string& note)
    : sink_(make_sink(file, note)), header_(y4m_header(format, note)) {}

VideoFile::~VideoFile() = default;

void VideoFile::write(std::string_view frame) {
    if (!header_.empty()) sink_->write(std::exchange(header_, {}));
    sink_->write(frame);
}

void VideoFile::commit() { sink_->commit(); }

}  // namespace kilolux
