// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/state_file.h"

#include <fmt/format.h>
#include <cstdlib>
#include <fstream>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/atomic_write.h"
#include "present/cli/conditions.h"
#include "present/cli/option_builder.h"
#include "present/cli/options.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Names = std::vector<std::string>;

constexpr int kVersion = 2;

// Calls `visit` with every value that is kept: those that the panel shares with the command line,
// then the window's own.
void visit_state(ViewState& state, const SettingVisitor& visit) {
    SharedOptions shared;
    shared.settings = state.settings;
    shared.rig = state.rig;
    shared.emissive_lights = state.emissive_lights;
    visit_settings(shared, [&visit](const Setting& setting) {
        if (setting.text.effect.in_panel) visit(setting);
    });
    state.settings = shared.settings;
    state.rig = shared.rig;
    state.emissive_lights = shared.emissive_lights;
    GridSettings& grid = state.settings.grid;
    OptionBuilder(visit, "Window")
        .count({"fine-slices"}, grid.fine_per_octave, kSlicesRange)
        .flag("count-useful", state.settings.want.counts, "")
        .flag("lights-move", state.lights_move, "")
        .number({"light-speed"}, state.light_speed, {0.01, 100.0})
        .choice({"camera-mode"}, state.camera_mode, Names{"fly", "orbit"})
        .flag("adaptive", state.adaptive, "")
        .number({"target-ms"}, state.target_ms, {1.0, 1e4})
        .number({"scale"}, state.fixed_scale, {0.05, 1.0})
        .flag("continuous", state.continuous, "")
        .flag("vsync", state.vsync, "")
        .flag("panel", state.show_panel, "")
        .flag("overlay", state.show_overlay, "")
        .flag("probe", state.probe, "")
        .value(
            SettingKind::numbers, {"--resolution"},
            [&size = state.window_size](const auto& name, const auto& text) {
                const auto [width, height] = parse_resolution(name, text);
                size = {width, height};
            },
            [&size = state.window_size] { return fmt::format("{},{}", size[0], size[1]); });
}

Json values_of(ViewState state) {
    Json out = {{"version", kVersion}};
    visit_state(state,
                [&out](const Setting& setting) { out[setting.word()] = value_json(setting); });
    return out;
}

// Takes the values of `json`, but for options that `is_given`.
void take_values(const Json& json, ViewState& state,
                 const std::function<bool(const std::string&)>& is_given) {
    visit_state(state, [&](const Setting& setting) {
        const auto found = json.find(setting.word());
        if (found == json.end() || is_given(setting.option())) return;
        if (setting.kind == SettingKind::flag && !found->is_boolean()) {
            throw Error(setting.word() + " is not true or false");
        }
        setting.take(found->is_string() ? found->get<std::string>() : found->dump());
    });
}

Json parse_file(const fs::path& file) {
    std::ifstream in(file);
    Json json = Json::parse(in, nullptr, false);
    if (!json.is_object()) throw Error("it is not a JSON object");
    if (json.value("version", 0) != kVersion) throw Error("it has another version");
    return json;
}

}  // namespace

fs::path view_state_file() {
    const auto folder = [](const char* variable) -> fs::path {
        const char* value = std::getenv(variable);
        const fs::path path = value != nullptr ? value : "";
        return path.is_absolute() ? path : fs::path();
    };
    const fs::path config = folder("XDG_CONFIG_HOME");
    if (!config.empty()) return config / "kilolux" / "view.json";
    const fs::path home = folder("HOME");
    return home.empty() ? fs::path() : home / ".config" / "kilolux" / "view.json";
}

ViewState StateFile::load(const ViewState& state,
                          const std::function<bool(const std::string&)>& is_given) {
    ViewState kept, started = state;
    std::error_code error;
    try {
        if (fs::exists(file_, error)) {
            const Json json = parse_file(file_);
            // Throws before `started` changes.
            take_values(json, kept, [](const std::string&) { return false; });
            take_values(json, started, is_given);
            written_ = json;
        }
    } catch (const std::exception& failure) {
        warn(file_.string() + ": ignored: " + failure.what());
        kept = {};
    }
    saved_ = seen_ = started;
    kept_ = values_of(kept);
    started_ = values_of(started);
    return started;
}

void StateFile::forget() {
    Json defaults = values_of({});
    defaults["resolution"] = kept_["resolution"];
    kept_ = defaults;
}

void StateFile::save(const ViewState& state) {
    if (file_.empty()) return;
    Json now = values_of(state);
    for (auto& [name, value] : now.items()) {
        if (value == started_[name]) value = kept_[name];
    }
    if (now == written_) return;
    std::error_code error;
    fs::create_directories(file_.parent_path(), error);
    write_atomically(file_, now.dump(2) + "\n");
    written_ = now;
}

void StateFile::keep(const ViewState& state, double now) {
    constexpr double kKeepSeconds = 0.5;
    if (now < next_look_) return;
    next_look_ = now + kKeepSeconds;
    if (state != saved_ && state == seen_) {
        saved_ = state;
        try {
            save(state);
        } catch (const Error& error) {
            warn(error.what());
        }
    }
    seen_ = state;
}

}  // namespace kilolux
