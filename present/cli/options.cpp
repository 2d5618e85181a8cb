// SPDX-License-Identifier: Apache-2.0
#include "present/cli/options.h"

#include "host/base/log.h"
#include "host/base/text.h"
#include "host/render/plan/settings_check.h"
#include "present/cli/option_builder.h"
#include "present/cli/scene_choice.h"

namespace kilolux {
namespace {

void check_reflections(const SharedOptions& options) {
    refuse_if(!options.shows_environment, "--reflections: only render and view show it");
    refuse_if(options.environment.empty(), "--reflections: needs --environment FILE|studio|sky");
    refuse_if(is_forward(options.settings.renderer),
              "--reflections: needs --renderer deferred or deferred-all");
}

}  // namespace

void add_shared_options(CLI::App& command, SharedOptions& options) {
    add_options(command, options);
    add_question(command, "Device", "--list-devices", "Print the OpenCL devices and leave");
}

void begin_command(const SharedOptions& options, bool compares) {
    refuse_if(options.quiet && options.verbose, "--quiet and --verbose exclude each other");
    refuse_if(options.show_error && !compares,
              "--show error: needs --reference FILE, which render takes");
    check_settings(options.settings);
    if (options.reflections) check_reflections(options);
    check_environment(options.environment);
    refuse_if(
        options.rig == Rig::swarm && options.lights_given && options.settings.lights.count == 0,
        "--rig swarm: needs lights, and --lights is 0");
    set_verbosity(options.quiet     ? Verbosity::quiet
                  : options.verbose ? Verbosity::verbose
                                    : Verbosity::normal);
}

std::string option_words(const std::vector<Setting>& settings, const std::vector<Setting>& defaults,
                         Changes least) {
    const auto differs = [&](std::size_t i) { return settings[i].show() != defaults[i].show(); };
    // The default number of lights and the default ambient light hold for some rigs only.
    bool has_own_rig = false;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        has_own_rig = has_own_rig || (settings[i].option() == "--rig" && differs(i));
    }
    std::string out;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const Setting& setting = settings[i];
        const std::string name = setting.option();
        const bool of_rig = has_own_rig && (name == "--lights" || name == "--ambient");
        const bool is_said = (differs(i) || of_rig) && setting.text.effect.changes >= least;
        if (!is_said || name == "SCENE" || setting.heading == "General") continue;
        out += " " + name;
        if (setting.kind != SettingKind::flag) out += " " + shell_word(setting.show());
    }
    return out;
}

}  // namespace kilolux
