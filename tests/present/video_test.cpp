// SPDX-License-Identifier: Apache-2.0
// Videos: y4m frame by frame, and what ffmpeg makes of it.
#include <gtest/gtest.h>
#include <time.h>
#include <array>
#include <cmath>
#include <sstream>

#include "host/base/system/child_process.h"
#include "present/image/image_file.h"
#include "present/image/read.h"
#include "present/video/video_file.h"
#include "tests/support/child.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

constexpr int kVideoWidth = 48, kVideoHeight = 32;
constexpr std::size_t kPixels = std::size_t{kVideoWidth} * kVideoHeight;

std::vector<std::string> small_video(const fs::path& output, std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"render",   "grid", "--resolution", "48,32",        "-q",
                                      "--lights", "20",   "-o",           output.string()};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

struct Y4m {
    std::string header;
    std::vector<std::string> frames;  // planes Y', Cb, Cr
    std::string rest;                 // bytes after the last whole frame
};

// Of frames with `frame_bytes` bytes in their planes.
Y4m parse_y4m(const std::string& bytes, std::size_t frame_bytes = 3 * kPixels) {
    const std::string mark = "FRAME\n";
    Y4m out;
    std::size_t at = bytes.find('\n') + 1;
    out.header = bytes.substr(0, at);
    while (bytes.size() - at >= mark.size() + frame_bytes && bytes.substr(at, 6) == mark) {
        out.frames.push_back(bytes.substr(at + mark.size(), frame_bytes));
        at += mark.size() + frame_bytes;
    }
    out.rest = bytes.substr(at);
    return out;
}

double code(const std::string& planes, std::size_t i) {
    return static_cast<unsigned char>(planes[i]);
}

// R', G', B' from 0 to 1 by BT.709's inverse.
std::array<double, 3> rgb_at(const std::string& planes, std::size_t i) {
    const double y = (code(planes, i) - 16.0) / 219.0;
    const double cb = (code(planes, i + kPixels) - 128.0) / 224.0;
    const double cr = (code(planes, i + 2 * kPixels) - 128.0) / 224.0;
    const double r = y + 1.5748 * cr, b = y + 1.8556 * cb;
    return {r, (y - 0.2126 * r - 0.0722 * b) / 0.7152, b};
}

TEST(Video, CodesAreThoseOfBt709) {
    const std::vector<std::uint8_t> colours = {0,   0, 0,   255, 255, 255, 255, 255,
                                               255, 0, 0,   255, 0,   255, 0,   255,
                                               0,   0, 255, 255, 128, 128, 128, 255};
    std::string out;
    y4m_frame(colours, out);
    // Table values: 16 + 219 Y', 128 + 224 Pb, 128 + 224 Pr.
    const std::vector<int> expected = {16,  235, 63,  173, 32,  126,   // Y'
                                       128, 128, 102, 42,  240, 128,   // Cb
                                       128, 128, 240, 26,  118, 128};  // Cr
    ASSERT_EQ(out.substr(0, 6), "FRAME\n");
    ASSERT_EQ(out.size(), 6 + expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(static_cast<unsigned char>(out[6 + i]), expected[i]) << i;
    }
}

// Of all colours: 16 + 219 Y', 128 + 224 Pb, 128 + 224 Pr, rounded; halves either way.
TEST(Video, CodesAreTheNearest) {
    constexpr std::size_t kColours = 1 << 24;
    std::vector<std::uint8_t> colours(4 * kColours);
    for (std::size_t i = 0; i < colours.size(); ++i) {
        colours[i] = static_cast<std::uint8_t>(i / 4 >> (8 * (i % 4)));
    }
    std::string out(10, 'x');
    y4m_frame(colours, out);
    ASSERT_EQ(out.size(), 6 + 3 * kColours);
    std::size_t wrong = 0;
    const auto check = [&](std::size_t plane, std::size_t i, double code) {
        const double seen = static_cast<unsigned char>(out[6 + plane * kColours + i]);
        wrong += std::abs(seen - code) > 0.5 + 1e-9 ? 1 : 0;
    };
    for (std::size_t i = 0; i < kColours; ++i) {
        const double r = colours[4 * i] / 255.0, g = colours[4 * i + 1] / 255.0,
                     b = colours[4 * i + 2] / 255.0;
        const double y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
        check(0, i, 16.0 + 219.0 * y);
        check(1, i, 128.0 + 224.0 * (b - y) / 1.8556);
        check(2, i, 128.0 + 224.0 * (r - y) / 1.5748);
    }
    EXPECT_EQ(wrong, 0u);
}

// Vectors and the ends that fill none, of all colours one after the other.
TEST(Video, CodesAreTheSameByAllInstructions) {
    const std::span<const PlaneMaker> makers = plane_makers();
    if (makers.size() < 2) GTEST_SKIP() << "this processor has no AVX2";
    constexpr std::size_t kRow = 4099, kColours = 1 << 24;
    std::vector<std::uint8_t> row(4 * kRow);
    std::string first(3 * kRow, 'x'), other = first;
    for (std::size_t begin = 0; begin < kColours; begin += kRow) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            row[i] = static_cast<std::uint8_t>((begin + i / 4) >> (8 * (i % 4)));
        }
        makers.front()(row.data(), kRow, first.data());
        makers.back()(row.data(), kRow, other.data());
        ASSERT_EQ(first, other) << "from colour " << begin;
    }
}

TEST(Video, PacesAreRatios) {
    const auto text = [](double value) {
        const Ratio r = ratio_of(value);
        return std::to_string(r.numerator) + ":" + std::to_string(r.denominator);
    };
    EXPECT_EQ(text(24.0), "24:1");
    EXPECT_EQ(text(12.5), "25:2");
    EXPECT_EQ(text(23.976), "2997:125");
    EXPECT_EQ(text(30000.0 / 1001.0), "30000:1001");
    EXPECT_EQ(text(29.97002997), "30000:1001");
    EXPECT_EQ(text(1e6), "1000000:1");
    EXPECT_EQ(text(1e-12), "1:2147483647");
    EXPECT_LE(y4m_header({65536, 65536, 30000.0 / 1001.0}, "a note").size(), 95u);
}

TEST(Video, AY4mHoldsThePicturesOfTheSequence) {
    const TemporaryFolder folder;
    const std::vector<std::string> frames = {"--frames", "3:6", "--fps", "12.5"};
    ASSERT_EQ(run_kilolux(small_video(folder / "f.#.png", frames)).code, 0);
    const ChildResult result = run_kilolux(small_video(folder / "a.y4m", frames));
    ASSERT_EQ(result.code, 0) << result.err;
    const Y4m video = parse_y4m(text_of_file(folder / "a.y4m"));
    const std::string header =
        "YUV4MPEG2 W48 H32 F25:2 Ip A1:1 C444 XCOLORRANGE=LIMITED XMATRIX=BT709 X";
    EXPECT_TRUE(video.header.starts_with(header)) << video.header;
    EXPECT_EQ(video.header.size(), header.size() + 9) << "8 digits of the command's hash";
    ASSERT_EQ(video.frames.size(), 4u);
    EXPECT_EQ(video.rest, "");
    EXPECT_NE(video.frames[0], video.frames[1]) << "lights move";
    // Half a code of Y' and of Cb are 0.5 / 219 and 0.5 / 224 * 1.8556.
    constexpr double kRounding = 0.5 / 219.0 + 0.5 / 224.0 * 1.8556 + 1e-6;
    for (std::size_t f = 0; f < 4; ++f) {
        const FloatImage png = read_image(folder / ("f." + std::to_string(3 + f) + ".png"));
        for (std::size_t i = 0; i < kPixels; ++i) {
            const std::array<double, 3> rgb = rgb_at(video.frames[f], i);
            for (std::size_t c = 0; c < 3; ++c) {
                ASSERT_NEAR(rgb[c], png.values[3 * i + c], kRounding)
                    << "frame " << f << " pixel " << i << " channel " << c;
            }
        }
    }
}

TEST(Video, StandardOutputHoldsTheSameBytesAndOnePictureIsOneFrame) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_kilolux(small_video(folder / "a.y4m")).code, 0);
    const ChildResult piped = run_kilolux(small_video("-"));
    ASSERT_EQ(piped.code, 0) << piped.err;
    EXPECT_EQ(piped.out, text_of_file(folder / "a.y4m"));
    EXPECT_EQ(parse_y4m(piped.out).frames.size(), 1u);
    EXPECT_EQ(names_in(folder), (std::set<std::string>{"a.y4m"}));
}

// Codes that the renderer does not make itself go through the same transform.
TEST(Video, ShowsTheErrorAgainstAReference) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_kilolux(small_video(folder / "r.exr")).code, 0);
    const std::vector<std::string> shown = {"--show", "error", "--reference",
                                            (folder / "r.exr").string()};
    ASSERT_EQ(run_kilolux(small_video(folder / "e.png", shown)).code, 0);
    ASSERT_EQ(run_kilolux(small_video(folder / "e.y4m", shown)).code, 0);
    const Y4m video = parse_y4m(text_of_file(folder / "e.y4m"));
    ASSERT_EQ(video.frames.size(), 1u);
    const FloatImage png = read_image(folder / "e.png");
    EXPECT_NEAR(rgb_at(video.frames[0], 0)[0], png.values[0], 0.01);
}

// Waits until the video that is being written has bytes, for two minutes at most.
void wait_for_bytes(const TemporaryFolder& folder, const std::string& end) {
    const timespec pause{0, 5'000'000};
    for (int i = 0; i < 24'000; ++i) {
        for (const std::string& name : names_in(folder)) {
            std::error_code gone;
            if (name.ends_with(end) && fs::file_size(folder / name, gone) > 0 && !gone) return;
        }
        nanosleep(&pause, nullptr);
    }
}

TEST(Video, ASignalLeavesNoFile) {
    for (const char* name : {"a.y4m", "a.mp4"}) {
        if (fs::path(name).extension() == ".mp4" && !has_program("ffmpeg")) continue;
        const TemporaryFolder folder;
        const ChildResult result =
            run_kilolux(small_video(folder / name, {"--frames", "0:1000000"}), [&](pid_t child) {
                wait_for_bytes(folder, ".part");
                kill(child, SIGINT);
            });
        EXPECT_EQ(result.code, 130) << name << " signal " << result.signal << " " << result.err;
        EXPECT_EQ(result.err, "kilolux: interrupted\n");
        EXPECT_EQ(names_in(folder), std::set<std::string>{}) << name;
    }
}

TEST(Video, ASignalEndsAPipedVideoAtAWholeFrame) {
    const TemporaryFolder folder;
    std::ostringstream command;
    command << "exec '" << program_file() << "'";
    for (const std::string& word : small_video("-", {"--frames", "0:1000000"})) {
        command << " '" << word << "'";
    }
    command << " >'" << (folder / "out.y4m").string() << "'";
    const ChildResult result = run_child({"/bin/sh", "-c", command.str()}, [&](pid_t child) {
        wait_for_bytes(folder, ".y4m");
        kill(child, SIGINT);
    });
    EXPECT_EQ(result.code, 130) << result.err;
    const Y4m video = parse_y4m(text_of_file(folder / "out.y4m"));
    EXPECT_GE(video.frames.size(), 1u);
    EXPECT_EQ(video.rest, "");
}

std::string text_of_program(std::vector<std::string> words) {
    words.insert(words.begin(), "/usr/bin/env");
    const ChildResult result = run_child(words);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.out;
}

class FfmpegVideo : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Types, FfmpegVideo, ::testing::Values("a.mp4", "a.mkv", "a.webm"));

TEST_P(FfmpegVideo, HoldsThePicturesAndSaysItsColours) {
    if (!has_program("ffmpeg") || !has_program("ffprobe")) GTEST_SKIP() << "needs ffmpeg";
    const TemporaryFolder folder;
    const std::vector<std::string> frames = {"--frames", "0:4", "--fps", "10"};
    const std::string file = (folder / GetParam()).string();
    ASSERT_EQ(run_kilolux(small_video(folder / "a.y4m", frames)).code, 0);
    const ChildResult result = run_kilolux(small_video(file, frames));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(names_in(folder).size(), 2u);
    const std::string streams =
        text_of_program({"ffprobe", "-v", "error", "-show_streams", "-count_frames", file});
    for (const char* said : {"color_range=tv", "color_space=bt709", "color_transfer=iec61966-2-1",
                             "color_primaries=bt709", "chroma_location=left", "pix_fmt=yuv420p",
                             "width=48", "height=32", "r_frame_rate=10/1", "nb_read_frames=5"}) {
        EXPECT_TRUE(contains(streams, said)) << said << "\n" << streams;
    }
    const std::string decoded = text_of_program({"ffmpeg", "-v", "error", "-i", file, "-f",
                                                 "yuv4mpegpipe", "-pix_fmt", "yuv420p", "pipe:1"});
    const Y4m before = parse_y4m(text_of_file(folder / "a.y4m"));
    const Y4m after = parse_y4m(decoded, kPixels * 3 / 2);
    ASSERT_EQ(after.frames.size(), before.frames.size());
    for (std::size_t f = 0; f < after.frames.size(); ++f) {
        double sum = 0.0;
        for (std::size_t i = 0; i < kPixels; ++i) {
            sum += std::abs(code(before.frames[f], i) - code(after.frames[f], i));
        }
        // Another range or matrix shifts codes by 16 or more; encoders lose about 1.
        EXPECT_LT(sum / kPixels, 4.0) << "frame " << f;
    }
}

// Renders again with --skip-existing; the video must be another one to be refused.
ChildResult skip_existing(const fs::path& file, std::vector<std::string> more = {}) {
    std::vector<std::string> words = small_video(file, {"--fps", "10", "--skip-existing"});
    words.erase(std::ranges::find(words, "-q"));
    if (std::ranges::find(more, "--frames") == more.end()) {
        words.insert(words.end(), {"--frames", "0:2"});
    }
    words.insert(words.end(), more.begin(), more.end());
    return run_kilolux(words);
}

void expect_refused(const fs::path& file, const std::vector<std::string>& more,
                    const std::string& why) {
    const std::string before = text_of_file(file);
    const ChildResult result = skip_existing(file, more);
    EXPECT_EQ(result.code, 1) << why;
    EXPECT_TRUE(contains(result.err, file.string() + ": holds another video: its " + why))
        << result.err;
    EXPECT_EQ(text_of_file(file), before);
}

// A part of a video is made anew.
void expect_made_anew(const fs::path& file, const std::string& part) {
    const std::string whole = text_of_file(file);
    write_text(file, part);
    const ChildResult result = skip_existing(file);
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(contains(result.err, "it is made anew")) << result.err;
    EXPECT_EQ(text_of_file(file), whole);
}

TEST(Video, IsLeftOutWhereItIsThere) {
    const TemporaryFolder folder;
    const fs::path file = folder / "a.y4m";
    ASSERT_EQ(skip_existing(file).code, 0);
    const auto made = fs::last_write_time(file);
    EXPECT_TRUE(contains(skip_existing(file).err, "every file is there"));
    EXPECT_EQ(fs::last_write_time(file), made);
    expect_refused(file, {"--resolution", "32,48"}, "size is '48x32', but '32x48' is asked for");
    expect_refused(file, {"--frames", "0:3"}, "number of frames is '3', but '4' is asked for");
    expect_refused(file, {"--fps", "12"}, "header is 'YUV4MPEG2 W48 H32 F10:1 ");
    expect_refused(file, {"--light-seed", "9"}, "header is 'YUV4MPEG2 W48 H32 F10:1 ");
    const std::string whole = text_of_file(file);
    expect_made_anew(file, "");
    expect_made_anew(file, "no video");
    expect_made_anew(file, "YUV4MPEG2 W48 H32 F10:1");
    expect_made_anew(file, whole.substr(0, whole.size() - 1));
    std::string broken = whole;
    broken[whole.find("FRAME", 2 * kPixels)] = 'f';
    expect_made_anew(file, broken);
    const std::string other = "YUV4MPEG2 W48 H32 F10:1 Ip A1:1 C420jpeg\nFRAME\nabc";
    write_text(file, other);
    expect_refused(file, {}, "header is 'YUV4MPEG2 W48 H32 F10:1 Ip A1:1 C420jpeg");
}

TEST_P(FfmpegVideo, IsLeftOutWhereItIsThere) {
    if (!has_program("ffmpeg") || !has_program("ffprobe")) GTEST_SKIP() << "needs ffmpeg";
    const TemporaryFolder folder;
    const fs::path file = folder / GetParam();
    ASSERT_EQ(skip_existing(file).code, 0);
    const auto made = fs::last_write_time(file);
    EXPECT_TRUE(contains(skip_existing(file).err, "every file is there"));
    EXPECT_EQ(fs::last_write_time(file), made);
    expect_refused(file, {"--resolution", "32,48"}, "size is '48x32', but '32x48' is asked for");
    expect_refused(file, {"--frames", "0:3"}, "command is 'kilolux render grid ");
    expect_refused(file, {"--light-seed", "9"}, "command is 'kilolux render grid ");
    const std::string whole = text_of_file(file);
    expect_made_anew(file, "");
    expect_made_anew(file, whole.substr(0, whole.size() - 200));
}

TEST(Video, TheSameCommandGivesTheSameBytesOfFfmpeg) {
    if (!has_program("ffmpeg")) GTEST_SKIP() << "needs ffmpeg";
    const TemporaryFolder folder;
    for (const char* name : {"a.mkv", "b.mkv"}) {
        ASSERT_EQ(run_kilolux(small_video(folder / name)).code, 0);
    }
    EXPECT_EQ(text_of_file(folder / "a.mkv"), text_of_file(folder / "b.mkv"));
}

// kilolux render with PATH as its only program folder.
ChildResult render_with_path(const fs::path& path, const fs::path& output) {
    std::vector<std::string> words = {"/usr/bin/env", "PATH=" + path.string(), program_file()};
    for (std::string& word : small_video(output)) words.push_back(word);
    return run_child(words);
}

TEST(Video, AMissingOrFailingFfmpegIsOneLine) {
    const TemporaryFolder folder, programs;
    const fs::path file = folder / "-a:b.mp4";
    const ChildResult missing = render_with_path(programs.path(), file);
    EXPECT_EQ(missing.code, 1);
    EXPECT_EQ(missing.err, "kilolux: " + file.string() +
                               ": ffmpeg not found; install the package ffmpeg, or write .y4m\n");
    write_text(programs / "ffmpeg", "#!/bin/sh\necho 'no such encoder' >&2\nexit 1\n");
    fs::permissions(programs / "ffmpeg", fs::perms::owner_all);
    const ChildResult failing = render_with_path(programs.path(), file);
    EXPECT_EQ(failing.code, 1);
    EXPECT_EQ(failing.err, "kilolux: " + file.string() + ": ffmpeg failed: no such encoder\n");
    EXPECT_EQ(names_in(folder), std::set<std::string>{});
}

TEST(Video, RefusesWhatAVideoCannotHold) {
    const auto refusal = [](const fs::path& file, std::vector<std::string> more) {
        const ChildResult result = run_kilolux(small_video(file, std::move(more)));
        EXPECT_EQ(result.code, 2) << result.err;
        return result.err;
    };
    EXPECT_TRUE(contains(refusal("a.##.mp4", {"--frames", "0:3"}), "'a.##.mp4' is a video"));
    EXPECT_TRUE(contains(refusal("a.mp4", {"--frames", "0:3", "--shard", "0/2"}), "--shard: "));
    EXPECT_TRUE(contains(refusal("a.y4m", {"--aov", "depth"}), "--aov: 'a.y4m' is a video"));
    EXPECT_TRUE(contains(refusal("a.y4m", {"--exr-half"}), "--exr-half: "));
    EXPECT_TRUE(contains(refusal("a.y4m", {"--bits", "16"}), "--bits: "));
    EXPECT_TRUE(contains(refusal("a.mkv", {"--resolution", "33,32"}), "33x32: H.264"));
    EXPECT_TRUE(contains(refusal("-", {"--stats", "-"}), "--stats: standard output"));
}

}  // namespace
}  // namespace kilolux
