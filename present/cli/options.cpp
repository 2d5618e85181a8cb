// SPDX-License-Identifier: Apache-2.0
#include "present/cli/options.h"

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/text.h"
#include "host/render/plan/settings_check.h"
#include "present/cli/option_builder.h"

namespace kilolux {
namespace {

void check_reflections(const SharedOptions& options) {
    if (!options.shows_environment) throw UsageError("--reflections: only render and view show it");
    if (options.environment.empty()) {
        throw UsageError("--reflections: needs --environment FILE|studio|sky");
    }
    if (is_forward(options.settings.renderer)) {
        throw UsageError("--reflections: needs --renderer deferred or deferred-all");
    }
}

}  // namespace

void add_shared_options(CLI::App& command, SharedOptions& options) {
    visit_settings(options, [&command](const Setting& setting) { add_option(command, setting); });
    add_question(command, "Device", "--list-devices", "Print the OpenCL devices and leave");
}

void begin_command(const SharedOptions& options, bool compares) {
    if (options.quiet && options.verbose) {
        throw UsageError("--quiet and --verbose exclude each other");
    }
    if (options.show_error && !compares) {
        throw UsageError("--show error: needs --reference FILE, which render takes");
    }
    check_settings(options.settings);
    if (options.reflections) check_reflections(options);
    if (options.rig == Rig::swarm && options.lights_given && options.settings.lights.count == 0) {
        throw UsageError("--rig swarm: needs lights, and --lights is 0");
    }
    set_verbosity(options.quiet     ? Verbosity::quiet
                  : options.verbose ? Verbosity::verbose
                                    : Verbosity::normal);
}

std::vector<Setting> settings_of(SharedOptions& options) {
    std::vector<Setting> out;
    visit_settings(options, [&out](const Setting& setting) { out.push_back(setting); });
    return out;
}

std::string option_words(SharedOptions options) {
    SharedOptions defaults;
    // The default number of lights and the default ambient light hold for some rigs only.
    const bool has_own_rig = options.rig != Rig::automatic;
    const std::vector<Setting> standard = settings_of(defaults), settings = settings_of(options);
    std::string out;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const Setting& setting = settings[i];
        const std::string name = setting.option(), value = setting.show();
        const bool of_rig = name == "--lights" || name == "--ambient";
        const bool is_standard = value == standard[i].show() && !(of_rig && has_own_rig);
        if (is_standard || name == "SCENE" || setting.heading == "General") continue;
        out += " " + name;
        if (setting.kind != SettingKind::flag) out += " " + shell_word(value);
    }
    return out;
}

}  // namespace kilolux
