// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "host/base/error.h"
#include "host/base/suggest.h"
#include "present/cli/option_builder.h"
#include "present/cli/options.h"
#include "present/image/image_file.h"
#include "present/video/video_file.h"

namespace kilolux {
namespace {

// The file's name; throws UsageError for an unknown type of picture.
std::string picture_file(const std::string&, const std::string& text) {
    image_meaning(text);
    return text;
}

// The same for an output, which may also be a video.
std::string output_file(const std::string&, const std::string& text) {
    if (is_video(text)) return text;
    const std::string extension = lower(std::filesystem::path(text).extension().string());
    std::vector<std::string> known = image_extensions();
    if (std::ranges::find(known, extension) != known.end()) return text;
    for (const std::string& video : video_extensions()) known.push_back(video);
    throw UsageError(fmt::format("{}: image type '{}' is none of {}{}", text, extension,
                                 joined(known), did_you_mean(extension, known)));
}

void add_encoding_options(CLI::App& command, OutputOptions& o) {
    const auto take_ids = [](const std::string& name, const std::string& text) {
        return parse_name(name, text, {"float", "uint"}) == 1;
    };
    const auto bits = [](const std::string& name, const std::string& text) {
        return parse_name(name, text, {"8", "16"}) == 0 ? 8 : 16;
    };
    OptionBuilder(command, "Output")
        .value({"--output,-o", "FILE", "",
                "Picture: .exr and .hdr linear, .png .jpg .jpeg .tif .tiff for the eye; a sequence "
                "has #### for the frame number. Video: .y4m, - for y4m on standard output, and "
                ".mp4 .mkv .webm where the program ffmpeg is installed"},
               o.output, output_file)
        .text({"--stats", "FILE", "", "Times and counts as JSON; - for standard output"}, o.stats)
        .rest()
        .flag("--exr-half", o.half_colour, "EXR colour in half precision")
        .value({"--aov-ids", "float|uint", "float",
                "How EXR holds layers of whole numbers; uint in any case above 16777216, where "
                "floats are not exact"},
               o.uint_ids, take_ids)
        .value({"--bits", "8|16", "", "Bits a channel of PNG and TIFF"}, o.bits, bits)
        .count({"--png-level", "N", "",
                "zlib's level of PNG, 0 to 9: higher ones take longer and make files smaller"},
               o.png_level, {0, 9})
        .text({"--ocio-view", "NAME|none", "the display's",
               "OpenColorIO view of pictures for the eye in place of --tonemap, where the "
               "environment's OCIO names a configuration; none: no OpenColorIO"},
              o.ocio.view)
        .text({"--ocio-display", "NAME", "the configuration's", "OpenColorIO display"},
              o.ocio.display)
        .text({"--ocio-input", "NAME", "linear Rec. 709, else scene_linear",
               "OpenColorIO colour space of the linear picture"},
              o.ocio.input);
}

void add_sequence_options(CLI::App& command, OutputOptions& o) {
    OptionBuilder(command, "Sequences")
        .value({"--frames", "A:B", "", "Frames A to B; frame f is at --time + f / --fps"}, o.frames,
               parse_frames)
        .number({"--fps", "F", "", "Frames a second"}, o.frames_per_second, {0.0, 1e6, true})
        .value({"--shard", "I/N", "0/1", "Only every N-th frame, from the I-th on, counted from 0"},
               o.shard, parse_shard)
        .number({"--turntable", "DEGREES", "",
                 "The camera goes so far around the vertical axis through the scene's middle over "
                 "the frames; 360 ends one step before its start"},
                o.turntable)
        .text({"--camera-keys", "FILE", "",
               "JSON list of {\"time\", \"position\", \"focal_point\", \"angle\"}, in seconds, "
               "metres and degrees: a smooth way through them"},
              o.camera_keys)
        .flag("--skip-existing", o.skip_existing,
              "Leave out frames whose file holds this picture, by its size and notes, and a video "
              "that holds these frames; another one there is refused, a file that is none is made "
              "anew");
}

void add_comparison_options(CLI::App& command, OutputOptions& o) {
    OptionBuilder(command, "Comparison")
        .text({"--reference", "FILE", "", "Compare the picture with this one"}, o.reference)
        .number({"--threshold", "T", "0", "Exit with 3 if the metric is above"}, o.threshold, {0.0})
        .choice({"--metric", "", "", "What is compared with the threshold"}, o.metric,
                metric_choices())
        .value({"--difference", "FILE", "",
                "Write the difference: .exr holds |picture - reference| a channel, .png a heat "
                "map, logarithmic from 1e-6 to 1"},
               o.difference, picture_file);
}

void check_sequence(const OutputOptions& options) {
    const auto check = [&options](const char* name, const std::filesystem::path& file) {
        const bool pattern = has_frame_pattern(file);
        if (options.frames && !pattern) {
            throw UsageError(fmt::format("{}: '{}' has no #### for the frame numbers of --frames",
                                         name, file.string()));
        }
        if (!options.frames && pattern) {
            throw UsageError(
                fmt::format("{}: '{}' has # for a frame number, but there is no --frames A:B", name,
                            file.string()));
        }
    };
    if (!is_video(options.output)) check("--output", options.output);
    if (!options.difference.empty()) check("--difference", options.difference);
    if (!options.frames && options.shard.count > 1) throw UsageError("--shard: needs --frames A:B");
}

void check_motion(const CameraChoice& camera, const OutputOptions& options) {
    if (options.turntable && !options.frames) throw UsageError("--turntable: needs --frames A:B");
    if (options.camera_keys.empty()) return;
    if (options.turntable) throw UsageError("--turntable and --camera-keys exclude each other");
    if (camera.position || camera.focal_point || camera.index || camera.framed) {
        throw UsageError(
            "--camera-keys: says where the camera is; leave out --camera-position, "
            "--camera-focal-point and --camera-index");
    }
}

// An option of what a picture's file holds.
struct FormatOption {
    const char* name;
    bool is_given;
    bool (*fits)(const std::filesystem::path& file);
    const char* misfit;  // of other files
};

std::vector<FormatOption> format_options(const SharedOptions& shared,
                                         const OutputOptions& options) {
    const bool has_layers = !shared.settings.want.aovs.empty();
    return {{"--aov", has_layers, holds_layers, "cannot hold layers; use .exr"},
            {"--exr-half", options.half_colour, holds_layers, "is not an EXR file"},
            {"--aov-ids", options.uint_ids, holds_layers, "is not an EXR file"},
            {"--bits", options.bits == 16, holds_16_bits,
             "cannot hold 16 bits a channel; use .png or .tif, or .exr for light"},
            {"--png-level", options.png_level != kPngLevel, is_png, "is not a PNG file"}};
}

// A video is one file of display pictures, of all frames.
void check_video(const SharedOptions& shared, const OutputOptions& options) {
    const std::string file = options.output.string();
    const auto refuse = [&file](bool asked, const char* what) {
        if (asked) throw UsageError(fmt::format("{}: '{}' is a video", what, file));
    };
    refuse(has_frame_pattern(file), "--output: #### for frame numbers");
    refuse(options.shard.count > 1, "--shard");
    for (const FormatOption& option : format_options(shared, options)) {
        refuse(option.is_given, option.name);
    }
    if (file == "-" && options.stats == "-") {
        throw UsageError("--stats: standard output is the video's; name a file");
    }
    check_video_size(file, shared.settings.width, shared.settings.height);
    uses_ocio(options.ocio);
}

void check_format(const SharedOptions& shared, const OutputOptions& options) {
    const std::string file = options.output.string();
    if (is_video(file)) return check_video(shared, options);
    for (const FormatOption& option : format_options(shared, options)) {
        if (!option.is_given || option.fits(file)) continue;
        throw UsageError(fmt::format("{}: '{}' {}", option.name, file, option.misfit));
    }
    if (image_meaning(file) == ImageMeaning::display) {
        uses_ocio(options.ocio);
    } else if (shared.show_error) {
        throw UsageError(fmt::format(
            "--show error: '{}' holds light; use .png, .jpg or .tif, or --difference", file));
    }
}

}  // namespace

void add_output_options(CLI::App& command, OutputOptions& options) {
    add_encoding_options(command, options);
    add_sequence_options(command, options);
    add_comparison_options(command, options);
}

void check_output_options(const SharedOptions& shared, const OutputOptions& options) {
    if (options.output.empty()) throw UsageError("--output: needs a file, e.g. -o picture.png");
    check_sequence(options);
    check_motion(shared.camera, options);
    check_format(shared, options);
    if (options.reference.empty() && options.threshold) {
        throw UsageError("--threshold: needs --reference FILE");
    }
    if (!options.reference.empty() && options.skip_existing) {
        throw UsageError("--skip-existing: leaves frames out that --reference would compare");
    }
    if (options.reference.empty() && !options.difference.empty()) {
        throw UsageError("--difference: needs --reference FILE");
    }
}

}  // namespace kilolux
