// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstdlib>

#include "host/base/atomic_write.h"
#include "host/base/error.h"
#include "host/base/log.h"
#include "present/cli/frame_summary.h"
#include "present/cli/option_builder.h"
#include "present/cli/scene_choice.h"
#include "present/image/image_file.h"
#include "present/program.h"
#include "present/window/app/session.h"
#include "present/window/app/state_file.h"

namespace kilolux {
namespace {

struct ViewOptions {
    SharedOptions shared;
    std::uint64_t exit_after = 0;
    std::string screenshot;
    std::string script;
    bool fresh = false;
};

// The kept state, with the values of the command line in place of the kept ones.
ViewState start_state(const ViewOptions& options, const CLI::App& command, StateFile& file) {
    ViewState state;
    state.settings = options.shared.settings;
    state.settings.background = options.shared.shown_background;
    state.settings.reflections = options.shared.maps;
    state.settings.want.aovs.clear();
    state.settings.want.probes = true;
    // Pictures that are counted are made one by one, each whole.
    const bool counts = options.exit_after > 0;
    if (!is_given(command, "--samples") && !counts) state.settings.samples = kRestSamples;
    if (is_given(command, "--resolution")) {
        state.window_size = {options.shared.settings.width, options.shared.settings.height};
    }
    // A rig without a swarm decides of lights and surround, whatever was kept.
    const bool rig_decides = options.shared.rig != Rig::automatic;
    return file.load(state, [&](const std::string& name) {
        const bool of_rig = name == "--lights" || name == "--ambient";
        return is_given(command, name) || (rig_decides && of_rig) ||
               (counts && name == "--samples");
    });
}

// Checks before the window opens what would fail when it closes.
void check_files(const ViewOptions& options) {
    if (options.screenshot.empty()) return;
    if (image_meaning(options.screenshot) == ImageMeaning::linear) {
        throw UsageError("--screenshot: " + options.screenshot +
                         ": a window is display-referred: PNG, JPEG or TIFF");
    }
    check_can_write(options.screenshot);
}

void run_view(ViewOptions& options, const CLI::App& command) {
    begin_command(options.shared);
    check_files(options);
    SessionOptions session;
    session.exit_after = options.exit_after;
    session.screenshot = options.screenshot;
    if (!options.script.empty()) session.script = read_script(options.script);
    choose_device(options.shared.settings.device);  // throws before anything is on the screen
    const WindowSystem system;
    StateFile file(options.fresh ? std::filesystem::path() : view_state_file());
    const Scene scene = open_scene(options.shared);
    session.shared = options.shared;
    session.state = start_state(options, command, file);
    const Window context({16, 16}, "Kilolux", false);
    Window window(session.state.window_size, "Kilolux - " + options.shared.scene, true);
    window.show();
    ViewSession view(scene, session, file, window, context);
    view.run();
    if (view.stop()) return;
    // All files are written; the process does not wait for a long kernel or compilation.
    std::fflush(nullptr);
    std::_Exit(0);
}

void add_view_options(CLI::App& command, ViewOptions& options) {
    options.shared.shows_environment = true;
    add_shared_options(command, options.shared);
    leave_to_help_all(command, {"--aov"});
    OptionBuilder(command, "Window")
        .flag("--fresh", options.fresh,
              "Begin with the defaults instead of the last window's settings; keep nothing")
        .count(
            {"--exit-after", "N", "", "Leave when N pictures have been made, also while minimised"},
            options.exit_after, {1, 1'000'000'000})
        .text({"--screenshot", "FILE", "", "Write what the window shows at the end"},
              options.screenshot)
        .text({"--script", "FILE", "",
               "Replay user input, one step per line, then leave; see present/window/README.md"},
              options.script);
}

constexpr const char* kExamples =
    "  kilolux view\n"
    "  kilolux view town.glb --lights 20000\n"
    "  kilolux view --exit-after 3 --screenshot window.png";

}  // namespace

void add_view_command(Program& program) {
    program.add_command("view", "Show a scene in a window and fly through it", kExamples,
                        add_view_options, run_view);
}

}  // namespace kilolux
