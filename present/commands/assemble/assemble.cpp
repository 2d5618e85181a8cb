// SPDX-License-Identifier: Apache-2.0
#include "present/commands/assemble/assemble.h"

#include <fmt/format.h>

#include "host/base/log.h"
#include "host/base/system/interrupt.h"
#include "present/cli/option_builder.h"
#include "present/cli/progress.h"
#include "present/commands/assemble/tiles.h"
#include "present/image/image_file.h"

namespace kilolux {
namespace {

void run_assemble(AssembleOptions& options) {
    constexpr std::size_t kSteps = 100;
    refuse_if(options.output.empty(), "--output: needs a file, e.g. -o whole.exr");
    if (options.quiet) set_verbosity(Verbosity::quiet);
    check_can_write_image(options.output);
    {
        Progress progress("joining", kSteps, progress_kind(options.progress, options.quiet));
        std::size_t steps = 0;
        join_tiles(options.output, options.tiles, [&](double share) {
            check_interrupt();
            for (; steps < static_cast<std::size_t>(share * kSteps); ++steps) progress.advance();
        });
    }
    note(fmt::format("wrote   {} of {} tiles", options.output.string(), options.tiles.size()));
}

constexpr const char* kAssembleExamples =
    "  kilolux render -o t.##.exr --resolution 65536,65536 --tiles 8x8 --shard 3/8\n"
    "  kilolux assemble -o whole.exr t.*.exr";

}  // namespace

void visit_settings(AssembleOptions& options, const SettingVisitor& f) {
    OptionBuilder(f, "Output")
        .text({"--output,-o", "FILE", "", "The picture: .exr, .png or .tif, as the tiles are"},
              options.output)
        .choice({"--progress", "", "", "How it tells how far it is"}, options.progress)
        .flag("--quiet,-q", options.quiet, "Only warnings and errors on stderr");
}

void add_assemble_options(CLI::App& command, AssembleOptions& options) {
    command
        .add_option("TILE", options.tiles, "Files of render --tiles, or of --crop, in any order")
        ->required()
        ->type_name("FILE");
    add_options(command, options);
}

void add_assemble_command(Program& program) {
    program.add_command("assemble", "Join the tiles of a picture, with the bytes of the whole",
                        kAssembleExamples, add_assemble_options, run_assemble);
}

}  // namespace kilolux
