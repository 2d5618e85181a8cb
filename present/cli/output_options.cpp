// SPDX-License-Identifier: Apache-2.0
#include "host/base/error.h"
#include "present/cli/option_builder.h"
#include "present/cli/options.h"
#include "present/image/comparison.h"
#include "present/image/image_file.h"

namespace kilolux {
namespace {

void add_encoding_options(CLI::App& command, OutputOptions& o) {
    const auto bits = [&o](const std::string& name, const std::string& text) {
        o.bits = parse_name(name, text, {"8", "16"}) == 0 ? 8 : 16;
    };
    Registrar(command, "Output")
        .flag("--exr-half", o.half_colour, "EXR colour in half precision")
        .value({"--bits", "8|16", "8", "Bits a channel of PNG and TIFF"}, bits)
        .text({"--ocio-view", "NAME|none", "the display's",
               "OpenColorIO view of pictures for the eye in place of --tonemap, where the "
               "environment's OCIO names a configuration; none leaves it out"},
              o.ocio.view)
        .text({"--ocio-display", "NAME", "the configuration's", "Its display"}, o.ocio.display)
        .text({"--ocio-input", "NAME", "linear Rec. 709, else scene_linear",
               "Its colour space that our light is in"},
              o.ocio.input);
}

void add_sequence_options(CLI::App& command, OutputOptions& o) {
    const auto frames = [&o](const std::string& name, const std::string& text) {
        o.frames = parse_frames(name, text);
    };
    const auto shard = [&o](const std::string& name, const std::string& text) {
        o.shard = parse_shard(name, text);
    };
    Registrar(command, "Sequences")
        .value({"--frames", "A:B", "", "Frames A to B; frame f is at --time + f / --fps"}, frames)
        .number({"--fps", "F", "24", "Frames a second"}, o.frames_per_second, {0.0, 1e6, true})
        .value({"--shard", "I/N", "0/1", "Only every N-th frame, from the I-th on, counted from 0"},
               shard)
        .flag("--skip-existing", o.skip_existing, "Leave frames alone whose file is there");
}

void add_comparison_options(CLI::App& command, OutputOptions& o) {
    Registrar(command, "Comparison")
        .text({"--reference", "FILE", "", "Compare the picture with this one"}, o.reference)
        .number({"--threshold", "T", "0", "Exit with 3 if the metric is above"}, o.threshold, {0.0})
        .choice({"--metric", "", "rmse", "What is compared"}, o.metric, metric_names());
}

}  // namespace

void add_output_options(CLI::App& command, OutputOptions& options) {
    const auto output = [&options](const std::string&, const std::string& text) {
        image_meaning(text);
        options.output = text;
    };
    Registrar(command, "Output")
        .value({"--output,-o", "FILE", "",
                "Picture: .exr and .hdr linear, .png .jpg .jpeg .tif .tiff for the eye; a sequence "
                "has #### for the frame number"},
               output)
        .text({"--stats", "FILE", "", "Times and counts as JSON; - for standard output"},
              options.stats);
    add_encoding_options(command, options);
    add_sequence_options(command, options);
    add_comparison_options(command, options);
}

void check_output_options(const SharedOptions& shared, const OutputOptions& options) {
    if (options.output.empty()) throw UsageError("--output: needs a file, e.g. -o picture.png");
    const bool pattern = has_frame_pattern(options.output);
    if (options.frames && !pattern) {
        throw UsageError("--output: '" + options.output.string() +
                         "' has no #### for the frame numbers of --frames");
    }
    if (!options.frames && pattern) {
        throw UsageError("--output: '" + options.output.string() +
                         "' has # for a frame number, but there is no --frames A:B");
    }
    if (!options.frames && options.shard.count > 1) throw UsageError("--shard: needs --frames A:B");
    if (!shared.settings.want.aovs.empty() && !holds_layers(options.output)) {
        throw UsageError("--aov: '" + options.output.string() + "' cannot hold layers; use .exr");
    }
    if (options.half_colour && !holds_layers(options.output)) {
        throw UsageError("--exr-half: '" + options.output.string() + "' is not an EXR file");
    }
    if (options.bits == 16 && !holds_16_bits(options.output)) {
        throw UsageError("--bits: '" + options.output.string() +
                         "' cannot hold 16 bits a channel; use .png or .tif, or .exr for light");
    }
    if (image_meaning(options.output) == ImageMeaning::display) uses_ocio(options.ocio);
    if (shared.quiet && shared.verbose)
        throw UsageError("--quiet and --verbose exclude each other");
}

}  // namespace kilolux
