// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "host/base/log.h"
#include "host/gpu/device.h"
#include "present/commands.h"
#include "present/frame_summary.h"
#include "present/registrar.h"
#include "present/scene_choice.h"
#include "present/window/session.h"

namespace kilolux {
namespace {

struct ViewOptions {
    SharedOptions shared;
    std::uint64_t exit_after = 0;
    std::string screenshot;
    std::string script;
};

void run_view(const ViewOptions& options) {
    set_verbosity(verbosity_of(options.shared));
    choose_device(options.shared.settings.device);  // throws before anything is on the screen
    SessionOptions session;
    session.shared = options.shared;
    session.state.settings = options.shared.settings;
    session.exit_after = options.exit_after;
    session.screenshot = options.screenshot;
    if (!options.script.empty()) session.script = read_script(options.script);
    const WindowSystem system;
    const Window context({16, 16}, "Kilolux", false);
    Window window(session.state.window_size, "Kilolux - " + options.shared.scene, true);
    const Scene scene = open_scene(options.shared.scene, options.shared.time);
    window.show();
    ViewSession(scene, session, window, context).run();
}

constexpr const char* kExamples =
    "  kilolux view\n"
    "  kilolux view town.glb --lights 20000\n"
    "  kilolux view --exit-after 3 --screenshot window.png";

}  // namespace

void add_view_command(Program& program) {
    const auto options = std::make_shared<ViewOptions>();
    CLI::App& command = program.add_command("view", "Show a scene in a window and fly through it",
                                            kExamples, [options] { run_view(*options); });
    add_shared_options(command, options->shared);
    Registrar(command, "Window")
        .count({"--exit-after", "N", "", "Leave when N pictures have been shown"},
               options->exit_after, {1, 1'000'000'000})
        .text({"--screenshot", "FILE", "", "Write what the window shows at the end"},
              options->screenshot)
        .text(
            {"--script", "FILE", "", "Do what the file's lines say, then leave; README tells how"},
            options->script);
}

}  // namespace kilolux
