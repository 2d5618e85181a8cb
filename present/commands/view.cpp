// SPDX-License-Identifier: Apache-2.0
#include "present/commands/view.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <set>
#include <utility>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/render/plan/settings_check.h"
#include "present/cli/option_builder.h"
#include "present/cli/scene_choice.h"
#include "present/image/image_file.h"
#include "present/window/app/session.h"
#include "present/window/app/state_file.h"
#include "present/window/screen/window.h"
#include "present/window/serve/served_screen.h"

namespace kilolux {
namespace {

ViewState kept_state(StateFile& file) {
    return file.load({}, [](const std::string&) { return false; });
}

// Takes the kept rig, unless the command line has options of lights. Returns whether it did.
bool take_kept_rig(SharedOptions& shared, const CLI::App& command, StateFile& file) {
    for (const char* name : {"--rig", "--lights", "--light-seed", "--light-radius",
                             "--light-intensity", "--light-size", "--light-box", "--environment"}) {
        if (is_given(command, name)) return false;
    }
    shared.rig = kept_state(file).rig;
    return shared.rig != Rig::automatic;
}

// Takes the kept choice of emissive lights, unless the command line has one, or it would have such
// lights beside settings of the command line that exclude them.
void take_kept_emissive_lights(SharedOptions& shared, const CLI::App& command, StateFile& file,
                               const Scene& scene) {
    if (is_given(command, "--emissive-lights")) return;
    const EmissiveLights kept = kept_state(file).emissive_lights;
    const std::string problem =
        kept == EmissiveLights::on && has_glowing_surfaces(scene)
            ? area_lights_problem(model_of(shared.settings.shading), shared.settings.shadows)
            : "";
    if (problem.empty()) {
        shared.emissive_lights = kept;
    } else {
        note("--emissive-lights: not the kept value: " + problem);
    }
}

// Kept settings that exclude lights with a size, where the scene or the command line has some, and
// a kept size where the command line has such settings: these wait for another run.
std::set<std::string> excluded_options(const ViewOptions& options, const CLI::App& command,
                                       const Scene& scene, const RenderSettings& kept) {
    const RenderSettings& asked = options.shared.settings;
    const auto is_asked = [&](const char* name) { return is_given(command, name); };
    const Shading shading = is_asked("--shading") ? asked.shading : kept.shading;
    const Shadows shadows = is_asked("--shadows") ? asked.shadows : kept.shadows;
    std::set<std::string> out;
    const auto exclude = [&](const char* name, const std::string& problem) {
        if (problem.empty() || is_asked(name)) return;
        note(std::string(name) + ": not the kept value: " + problem);
        out.insert(name);
    };
    if (has_area_lights(scene.lights, asked.lights)) {
        exclude("--shading", area_lights_problem(model_of(shading), Shadows::off));
        exclude("--shadows", area_lights_problem(SHADING_PBR, shadows));
    } else if (kept.lights.size > 0.0) {
        exclude("--light-size", area_lights_problem(model_of(shading), shadows));
    }
    return out;
}

// The kept state; values of the command line replace the kept ones. `asked`: before light_scene().
ViewState start_state(const ViewOptions& options, const CLI::App& command, StateFile& file,
                      const SharedOptions& asked, const Scene& scene, bool keeps_rig) {
    ViewState state = first_state(asked, options.shared);
    // Pictures that are counted are made one by one, each complete.
    const bool counts = options.exit_after > 0;
    if (!is_given(command, "--samples") && !counts) state.settings.samples = kRestSamples;
    if (is_given(command, "--resolution")) {
        state.window_size = {options.shared.settings.width, options.shared.settings.height};
    }
    // Lights and ambient light are kept with their rig; the command line's rig, if not a swarm, has
    // its own.
    const ViewState last = kept_state(file);
    const Rig kept = last.rig;
    const std::set<std::string> excluded = excluded_options(options, command, scene, last.settings);
    const bool is_swarm = options.shared.rig == Rig::automatic || options.shared.rig == Rig::swarm;
    const bool of_other_rig = kept != Rig::automatic && kept != Rig::swarm;
    const bool rig_decides = !keeps_rig && (!is_swarm || of_other_rig);
    return file.load(state, [&](const std::string& name) {
        const bool of_rig = name == "--lights" || name == "--ambient";
        const bool is_taken = name == "--rig" || name == "--emissive-lights";
        return is_given(command, name) || excluded.contains(name) || is_taken ||
               (rig_decides && of_rig) || (counts && name == "--samples");
    });
}

// Checks before the window opens what would otherwise fail when it closes.
void check_files(const ViewOptions& options) {
    if (options.screenshot.empty()) return;
    if (image_meaning(options.screenshot) == ImageMeaning::linear) {
        throw UsageError("--screenshot: " + options.screenshot +
                         ": a window is display-referred: PNG, JPEG or TIFF");
    }
    check_can_write_image(options.screenshot);
}

std::string window_title(const ViewOptions& options) { return "Kilolux - " + options.shared.scene; }

// Checks options that are wrong together, or name files that cannot be read.
void check_serving(const ViewOptions& options) {
    const ServerOptions& server = options.server;
    const bool tls = !server.certificate.empty();
    refuse_if(tls != !server.key.empty(), "--tls-certificate and --tls-key belong together");
    refuse_if(!options.serve && (tls || server.viewers > 0),
              std::string(tls ? "--tls-certificate" : "--viewers") + ": needs --serve");
    for (const auto& [name, file] :
         {std::pair{"--tls-certificate", server.certificate}, std::pair{"--tls-key", server.key}}) {
        if (!file.empty() && !std::ifstream(file)) {
            throw Error(std::string(name) + ": " + file + ": " + std::strerror(errno));
        }
    }
}

// Throws before the scene is loaded where the machine has no screen, or no port to serve one.
OpenScreen prepare_screen(const ViewOptions& options) {
    if (!options.serve) {
        return [system = std::make_shared<const WindowSystem>()](auto size, const auto& title) {
            return std::make_unique<Window>(system, size, title);
        };
    }
    ServerOptions server = options.server;
    server.address = *options.serve;
    auto screen = std::make_shared<std::unique_ptr<ServedScreen>>(
        std::make_unique<ServedScreen>(server, window_title(options)));
    return [screen](auto size, const auto&) {
        (*screen)->begin(size);
        std::printf("%s\n", (*screen)->address().c_str());
        std::fflush(stdout);
        return std::move(*screen);
    };
}

void run_view(ViewOptions& options, const CLI::App& command) {
    begin_command(options.shared);
    check_files(options);
    check_serving(options);
    SessionOptions session;
    session.exit_after = options.exit_after;
    session.screenshot = options.screenshot;
    if (!options.script.empty()) session.script = read_script(options.script);
    choose_device(options.shared.settings.device);  // throws before a window opens
    const OpenScreen open_screen = prepare_screen(options);
    StateFile file(options.fresh ? std::filesystem::path() : view_state_file());
    const bool keeps_rig = take_kept_rig(options.shared, command, file);
    AnimatedScene scene = open_animated_scene(options.shared);
    take_kept_emissive_lights(options.shared, command, file, scene.scene());
    session.asked = options.shared;
    note(light_scene(options.shared, scene));
    session.shared = options.shared;
    session.state = start_state(options, command, file, session.asked, scene.scene(), keeps_rig);
    const std::unique_ptr<Screen> screen =
        open_screen(session.state.window_size, window_title(options));
    ViewSession view(scene, session, file, *screen);
    view.run();
    if (view.stop()) return;
    // All files are written; the process does not wait for a long kernel or compilation.
    std::fflush(nullptr);
    std::_Exit(0);
}

constexpr const char* kViewExamples =
    "  kilolux view\n"
    "  kilolux view town.glb --lights 20000\n"
    "  kilolux view --exit-after 3 --screenshot window.png\n"
    "  kilolux view atrium --serve";

}  // namespace

void visit_settings(ViewOptions& options, const SettingVisitor& f) {
    visit_settings(options.shared, f);
    OptionBuilder(f, "Window")
        .flag("--fresh", options.fresh,
              "Begin with the defaults instead of the last window's settings; keep nothing")
        .count({"--exit-after", "N", "never",
                "Leave when N pictures have been made, also while minimised", kNeither, "1"},
               options.exit_after, {1, 1'000'000'000})
        .text({"--screenshot", "FILE", "", "Write what the window shows at the end"},
              options.screenshot)
        .text({"--script", "FILE", "",
               "Replay user input, one step per line, then leave; see present/window/README.md"},
              options.script)
        .value({"--serve", "[ADDRESS:PORT]", "",
                "Show the window in a browser instead: the printed address opens it; without a "
                "value at 127.0.0.1 and a free port"},
               options.serve, parse_serve_address,
               [&options] { return options.serve ? text_of(*options.serve) : std::string(); })
        .count({"--viewers", "N", "", "Pages that may watch beside the one that drives", kNeither,
                "1"},
               options.server.viewers, {0, 16})
        .text({"--tls-certificate", "FILE", "", "Serve by https: the certificate (PEM)"},
              options.server.certificate)
        .text({"--tls-key", "FILE", "", "The certificate's key (PEM)"}, options.server.key);
}

void add_view_options(CLI::App& command, ViewOptions& options) {
    options.shared.shows_environment = true;
    add_options(command, options);
    leave_to_help_all(command, {"--aov"});
}

void add_view_command(Program& program) {
    program.add_command("view", "Show a scene in a window and fly through it", kViewExamples,
                        add_view_options, run_view);
}

}  // namespace kilolux
