// SPDX-License-Identifier: Apache-2.0
#include "present/cli/output_options.h"

#include <fmt/format.h>
#include <algorithm>

#include "host/base/error.h"
#include "host/base/suggest.h"
#include "host/render/plan/memory_plan.h"
#include "present/cli/option_builder.h"
#include "present/cli/sequence.h"
#include "present/image/image_file.h"
#include "present/video/video_file.h"

namespace kilolux {
namespace {

using Words = std::vector<std::string>;

// A new member does not compile here: add a row below, then its name.
void count_members(OutputOptions& options) {
    [[maybe_unused]] auto& [encoding, output, ocio, frames, frames_per_second, shard, crop, tiles,
                            turntable, camera_keys, skip_existing, stats, reference, threshold,
                            metric, difference, mixed_devices] = options;
    [[maybe_unused]] auto& [half_colour, uint_ids, bits, png_level, exr_compression] = encoding;
    [[maybe_unused]] auto& [display, view, input] = ocio;
}

// The file's name; throws UsageError for an unknown type of picture.
std::string picture_file(const std::string&, const std::string& text) {
    image_meaning(text);
    return text;
}

// The same for an output, which may also be a video.
std::string output_file(const std::string&, const std::string& text) {
    if (is_video(text)) return text;
    const std::string extension = lower(std::filesystem::path(text).extension().string());
    const std::vector<std::string> known = output_extensions();
    if (std::ranges::find(known, extension) != known.end()) return text;
    throw UsageError(fmt::format("{}: image type '{}' is none of {}{}", text, extension,
                                 joined(known), did_you_mean(extension, known)));
}

void visit_encoding(const SettingVisitor& f, OutputOptions& o) {
    Encoding& e = o.encoding;
    OptionBuilder(f, "Output")
        .value({"--output,-o", "FILE", "",
                fmt::format(
                    "Picture: {} linear, {} for the eye; a sequence has #### for the frame number. "
                    "Video: .y4m, - for y4m on standard output, and .mp4 .mkv .webm where the "
                    "program ffmpeg is installed",
                    joined(image_extensions(ImageMeaning::linear), " "),
                    joined(image_extensions(ImageMeaning::display), " "))},
               o.output, output_file)
        .text({"--stats", "FILE", "", "Times and counts as JSON; - for standard output"}, o.stats)
        .rest()
        .flag("--exr-half", e.half_colour, "EXR colour in half precision", kPicture)
        .choice({"--exr-compression", "", "",
                 "How EXR is compressed, without loss; none is fastest", kTime},
                e.exr_compression, Words(std::begin(kExrCompressions), std::end(kExrCompressions)))
        .choice({"--aov-ids", "", "",
                 "How EXR holds layers of whole numbers; uint in any case above 16777216, where "
                 "floats are not exact",
                 kPicture},
                e.uint_ids, Words{"float", "uint"})
        .choice(
            {"--bits", "", "", "Bits a channel of PNG and TIFF", kPicture}, Words{"8", "16"},
            [&e](std::size_t place) { e.bits = place == 0 ? 8 : 16; },
            [&e] { return text_of(e.bits); })
        .count({"--png-level", "N", "",
                "zlib's level of PNG, 0 to 9: higher ones take longer and make files smaller",
                kTime, "1"},
               e.png_level, {0, 9})
        .text({"--ocio-view", "NAME|none", "the display's",
               "OpenColorIO view of pictures for the eye in place of --tonemap, where the "
               "environment's OCIO names a configuration; none: no OpenColorIO",
               kPicture},
              o.ocio.view)
        .text({"--ocio-display", "NAME", "the configuration's", "OpenColorIO display", kPicture},
              o.ocio.display)
        .text({"--ocio-input", "NAME", "linear Rec. 709, else scene_linear",
               "OpenColorIO colour space of the linear picture", kPicture},
              o.ocio.input);
}

void visit_sequence(const SettingVisitor& f, OutputOptions& o) {
    // A picture of a sequence is that of its time, which its notes hold.
    const bool one_file = is_video(o.output);
    OptionBuilder(f, "Sequences")
        .value({"--frames", "A:B", "",
                "Frames A to B; also a list of frames and ranges such as 1-99x2,105. Frame f is at "
                "--time + f / --fps",
                one_file || o.turntable ? kPicture : kNeither},
               o.frames, parse_frames)
        .number({"--fps", "F", "", "Frames a second", one_file ? kPicture : kNeither, "1/s"},
                o.frames_per_second, {0.0, 1e6, true})
        .value({"--shard", "I/N", "0/1", shard_meaning("frame or tile")}, o.shard, parse_shard)
        .value({"--crop", "X,Y,W,H", "",
                "Only these pixels of the picture, with the same bits; an EXR file has them as its "
                "data window. Takes the time of whole rows",
                kPicture, "px"},
               o.crop, parse_crop)
        .value({"--tiles", "CxR", "",
                "The picture as C columns and R rows of crops, a file each; #### in its name is "
                "the tile's number, and --shard spreads them"},
               o.tiles, parse_tiles)
        .number({"--turntable", "DEGREES", "",
                 "The camera goes so far around the vertical axis through the scene's middle over "
                 "the frames; 360 ends one step before its start",
                 kPicture, "degrees"},
                o.turntable)
        .input_file(
            {"--camera-keys", "FILE", "",
             "JSON list of {\"time\", \"position\", \"focal_point\", \"angle\"}, in seconds, "
             "metres and degrees: a smooth way through them",
             kPicture},
            o.camera_keys)
        .flag("--skip-existing", o.skip_existing,
              "Skip a picture or video whose file is there already: its size and its notes of "
              "command "
              "and input files tell. A file of another picture is an error; a file that is "
              "unreadable or cut off is made again");
}

void visit_comparison(const SettingVisitor& f, OutputOptions& o) {
    OptionBuilder(f, "Comparison")
        .input_file({"--reference", "FILE", "", "Compare the picture with this one"}, o.reference)
        .number({"--threshold", "T", "0", "Exit with 3 if the metric is above", kNeither,
                 "the metric's"},
                o.threshold, {0.0})
        .choice({"--metric", "", "", "What is compared with the threshold"}, o.metric,
                metric_choices())
        .value({"--difference", "FILE", "",
                "Write the difference: .exr holds |picture - reference| a channel, .png a heat "
                "map, logarithmic from 1e-6 to 1"},
               o.difference, picture_file);
    OptionBuilder(f, "Device")
        .flag("--mixed-devices", o.mixed_devices,
              "With several devices: they may differ, and so may the bits of what they make; each "
              "picture notes which ones made it");
}

void check_sequence(const OutputOptions& options) {
    const char* const numbers =
        options.tiles ? "tile numbers of --tiles" : "frame numbers of --frames";
    const bool is_one = !options.frames && !options.tiles;
    const auto check = [&](const char* name, const std::filesystem::path& file) {
        const bool pattern = has_frame_pattern(file);
        refuse_if(!is_one && !pattern,
                  fmt::format("{}: '{}' has no #### for the {}", name, file.string(), numbers));
        refuse_if(is_one && pattern,
                  fmt::format("{}: '{}' has # for a frame number, but there is no --frames A:B",
                              name, file.string()));
    };
    if (!is_video(options.output)) check("--output", options.output);
    if (!options.difference.empty()) check("--difference", options.difference);
    refuse_if(is_one && options.shard.count > 1, "--shard: needs --frames A:B or --tiles CxR");
}

void check_parts(const RenderSettings& settings, const OutputOptions& options) {
    refuse_if(options.tiles && options.frames, "--tiles: divides one picture; leave out --frames");
    refuse_if(options.tiles && options.crop, "--tiles and --crop exclude each other");
    const auto check = [&](const PixelRect& part, const char* name) {
        refuse_if(part.width > settings.width - part.x || part.height > settings.height - part.y ||
                      part.width < 1 || part.height < 1,
                  fmt::format("{}: {} is no part of a picture of {}x{} pixels", name, text_of(part),
                              settings.width, settings.height));
        refuse_if(
            std::uint64_t(part.width) * std::uint64_t(part.height) > kLargePicture,
            fmt::format("{}: {} has more than {} pixels", name, text_of(part), kLargePicture));
    };
    if (options.crop) check(*options.crop, "--crop");
    const int count = options.tiles ? options.tiles->columns * options.tiles->rows : 0;
    for (int i = 0; i < count; ++i) {
        check(tile_rect(*options.tiles, i, settings.width, settings.height), "--tiles");
    }
}

void check_motion(const CameraChoice& camera, const OutputOptions& options) {
    refuse_if(options.turntable && !options.frames, "--turntable: needs --frames A:B");
    if (options.camera_keys.empty()) return;
    refuse_if(options.turntable.has_value(), "--turntable and --camera-keys exclude each other");
    refuse_if(camera.position || camera.focal_point || camera.index || camera.framed,
              "--camera-keys: says where the camera is; leave out --camera-position, "
              "--camera-focal-point and --camera-index");
}

// An option of what a picture's file holds.
struct FormatOption {
    const char* name;
    bool is_given;
    bool (*fits)(const std::filesystem::path& file);
    const char* misfit;  // of other files
};

std::vector<FormatOption> format_options(const SharedOptions& shared, const Encoding& e) {
    const bool has_layers = !shared.settings.want.aovs.empty();
    const bool has_light_layers = !shared.light_groups.empty() && !shared.no_light_layers &&
                                  shared.settings.light_mix.gains.empty();
    return {{"--aov", has_layers, holds_layers, "cannot hold layers; use .exr"},
            {"--light-groups", has_light_layers, holds_layers, "cannot hold layers; use .exr"},
            {"--exr-half", e.half_colour, holds_layers, "is not an EXR file"},
            {"--exr-compression", e.exr_compression != kExrCompression, holds_layers,
             "is not an EXR file"},
            {"--aov-ids", e.uint_ids, holds_layers, "is not an EXR file"},
            {"--bits", e.bits == 16, holds_16_bits,
             "cannot hold 16 bits a channel; use .png or .tif, or .exr for light"},
            {"--png-level", e.png_level != kPngLevel, is_png, "is not a PNG file"}};
}

// A video is one file of display pictures, of all frames.
void check_video(const SharedOptions& shared, const OutputOptions& options) {
    const std::string file = options.output.string();
    const auto refuse_video = [&file](bool is_asked, const char* what) {
        refuse_if(is_asked, fmt::format("{}: '{}' is a video", what, file));
    };
    refuse_video(has_frame_pattern(file), "--output: #### for frame numbers");
    refuse_video(options.shard.count > 1, "--shard");
    for (const FormatOption& option : format_options(shared, options.encoding)) {
        refuse_video(option.is_given, option.name);
    }
    refuse_if(file == "-" && options.stats == "-",
              "--stats: standard output is the video's; name a file");
    refuse_video(options.tiles.has_value(), "--tiles");
    const auto [width, height] = written_size(shared.settings, options.crop);
    check_video_size(file, width, height);
    uses_ocio(options.ocio);
}

void check_format(const SharedOptions& shared, const OutputOptions& options) {
    const std::string file = options.output.string();
    if (is_video(file)) return check_video(shared, options);
    for (const FormatOption& option : format_options(shared, options.encoding)) {
        refuse_if(option.is_given && !option.fits(file),
                  fmt::format("{}: '{}' {}", option.name, file, option.misfit));
    }
    const bool for_the_eye = image_meaning(file) == ImageMeaning::display;
    if (for_the_eye) uses_ocio(options.ocio);
    refuse_if(!for_the_eye && shared.show_error,
              fmt::format("--show error: '{}' holds light; use .png, .jpg or .tif, or --difference",
                          file));
}

}  // namespace

std::pair<int, int> written_size(const RenderSettings& settings,
                                 const std::optional<PixelRect>& crop) {
    if (crop) return {crop->width, crop->height};
    return {settings.width, settings.height};
}

std::vector<std::string> output_extensions() {
    std::vector<std::string> out = image_extensions();
    for (const std::string& video : video_extensions()) out.push_back(video);
    return out;
}

void visit_settings(OutputOptions& options, const SettingVisitor& f) {
    count_members(options);
    visit_encoding(f, options);
    visit_sequence(f, options);
    visit_comparison(f, options);
}

void check_output_options(const SharedOptions& shared, const OutputOptions& options) {
    refuse_if(options.output.empty(), "--output: needs a file, e.g. -o picture.png");
    check_sequence(options);
    check_parts(shared.settings, options);
    check_motion(shared.camera, options);
    check_format(shared, options);
    check_progress(shared.progress, options.stats == "-" || options.output == "-");
    const bool compares = !options.reference.empty();
    refuse_if(!compares && options.threshold, "--threshold: needs --reference FILE");
    refuse_if(compares && options.skip_existing,
              "--skip-existing: leaves frames out that --reference would compare");
    refuse_if(!compares && !options.difference.empty(), "--difference: needs --reference FILE");
}

}  // namespace kilolux
