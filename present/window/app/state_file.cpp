// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/state_file.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <type_traits>

#include "host/base/atomic_write.h"
#include "host/base/error.h"
#include "host/base/log.h"
#include "host/picture/views.h"
#include "present/cli/names.h"
#include "present/cli/option_values.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Names = std::vector<std::string>;

constexpr int kVersion = 1;

// visit() below names each value once, for writing and for reading.
struct Writer {
    Json json = {{"version", kVersion}};

    template <typename T, typename Range>
    void number(const char* name, const char*, T& value, const Range&) {
        json[name] = value;
    }
    void flag(const char* name, bool& value) { json[name] = value; }
    template <typename Enum>
    void choice(const char* name, const char*, Enum& value, const Names& known) {
        json[name] = known.at(static_cast<std::size_t>(value));
    }
};

struct Reader {
    const Json& json;
    const std::function<bool(const std::string&)>& is_given;

    template <typename T, typename Range>
    void number(const char* name, const char* option, T& value, const Range& range) {
        if (!json.contains(name)) return;
        if (!json[name].is_number()) throw Error(std::string(name) + " is not a number");
        const double seen = json[name].get<double>();
        const bool whole = json[name].is_number_integer() || std::trunc(seen) == seen;
        if (!contains(range, seen) || (std::is_integral_v<T> && !whole)) {
            throw Error(std::string(name) + " is " + json[name].dump());
        }
        if (!is_given(option)) value = json[name].get<T>();
    }
    void flag(const char* name, bool& value) {
        if (!json.contains(name)) return;
        if (!json[name].is_boolean()) throw Error(std::string(name) + " is not true or false");
        value = json[name].get<bool>();
    }
    template <typename Enum>
    void choice(const char* name, const char* option, Enum& value, const Names& known) {
        const auto at = place(name, known);
        if (at && !is_given(option)) value = static_cast<Enum>(*at);
    }

 private:
    std::optional<std::size_t> place(const char* name, const Names& known) const {
        if (!json.contains(name)) return std::nullopt;
        if (!json[name].is_string()) throw Error(std::string(name) + " is not a word");
        return parse_name(name, json[name].get<std::string>(), known);
    }
};

template <typename Visitor>
void visit_picture(Visitor& v, RenderSettings& s) {
    v.choice("renderer", "--renderer", s.renderer, names_of<RendererKind>());
    v.choice("shading", "--shading", s.shading, names_of<Shading>());
    v.choice("gbuffer", "--gbuffer", s.gbuffer, gbuffer_choices().names);
    v.choice("show", "--show", s.want.view, view_names());
    v.number("exposure", "--exposure", s.exposure, kExposureRange);
    v.choice("tonemap", "--tonemap", s.tone_curve, names_of<ToneCurve>());
    v.number("bloom", "--bloom", s.bloom, kBloomRange);
    v.number("ambient", "--ambient", s.ambient, kAmbientRange);
    v.number("samples", "--samples", s.samples, kSamplesRange);
    v.number("lights", "--lights", s.lights.count, kLightsRange);
    v.number("light_seed", "--light-seed", s.lights.seed, kLightSeedRange);
    v.number("light_radius", "--light-radius", s.lights.radius, kZeroOrAboveRange);
    v.number("light_intensity", "--light-intensity", s.lights.intensity, kZeroOrAboveRange);
    v.number("tiles_x", "--grid", s.grid.tiles_x, kTilesRange);
    v.number("tiles_y", "--grid", s.grid.tiles_y, kTilesRange);
    v.number("slices", "--grid", s.grid.slices_per_octave, kSlicesRange);
    v.number("fine_slices", "--grid", s.grid.fine_per_octave, kSlicesRange);
    v.flag("count_useful", s.want.counts);
}

template <typename Visitor>
void visit(Visitor& v, ViewState& state) {
    visit_picture(v, state.settings);
    v.choice("rig", "--rig", state.rig, names_of<Rig>());
    v.flag("lights_move", state.lights_move);
    v.number("light_speed", "", state.light_speed, NumberRange{0.01, 100.0});
    v.choice("camera_mode", "", state.camera_mode, {"fly", "orbit"});
    v.flag("adaptive", state.adaptive);
    v.number("target_ms", "", state.target_ms, NumberRange{1.0, 1e4});
    v.number("scale", "", state.fixed_scale, NumberRange{0.05, 1.0});
    v.flag("continuous", state.continuous);
    v.flag("vsync", state.vsync);
    v.flag("panel", state.show_panel);
    v.flag("overlay", state.show_overlay);
    v.flag("probe", state.probe);
    v.number("width", "--resolution", state.window_size[0], kEdgeRange);
    v.number("height", "--resolution", state.window_size[1], kEdgeRange);
}

Json values_of(ViewState state) {
    Writer writer;
    visit(writer, state);
    return writer.json;
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
            Reader all{json, [](const std::string&) { return false; }};
            visit(all, kept);  // throws before `started` changes
            Reader not_given{json, is_given};
            visit(not_given, started);
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
    for (const char* name : {"width", "height"}) defaults[name] = kept_[name];
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
