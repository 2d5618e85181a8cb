// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/saved_state.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

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

constexpr int kVersion = 1;

// One direction for writing and reading: calls of add() name each value once.
class Writer {
 public:
    void number(const char* name, const char*, const double& value, const NumberRange&) {
        json[name] = value;
    }
    void flag(const char* name, const bool& value) { json[name] = value; }
    void word(const char* name, const char*, const std::string& value,
              const std::vector<std::string>&) {
        json[name] = value;
    }
    Json json = {{"version", kVersion}};
};

class Reader {
 public:
    Reader(const Json& json, const std::function<bool(const std::string&)>& is_given)
        : json_(json), is_given_(is_given) {}

    void number(const char* name, const char* option, double& value, const NumberRange& range) {
        if (!json_.contains(name)) return;
        if (!json_[name].is_number()) throw Error(std::string(name) + " is no number");
        const double seen = json_[name].get<double>();
        if (!(seen >= range.min && seen <= range.max)) {
            throw Error(std::string(name) + " is " + json_[name].dump());
        }
        if (!taken(option)) value = seen;
    }
    void flag(const char* name, bool& value) {
        if (!json_.contains(name)) return;
        if (!json_[name].is_boolean()) throw Error(std::string(name) + " is not true or false");
        value = json_[name].get<bool>();
    }
    void word(const char* name, const char* option, std::string& value,
              const std::vector<std::string>& known) {
        if (!json_.contains(name)) return;
        if (!json_[name].is_string()) throw Error(std::string(name) + " is no word");
        const std::string seen = json_[name].get<std::string>();
        parse_name(name, seen, known);
        if (!taken(option)) value = seen;
    }

 private:
    bool taken(const char* option) const { return *option != '\0' && is_given_(option); }

    const Json& json_;
    const std::function<bool(const std::string&)>& is_given_;
};

// Values of other types, seen as numbers and words.
template <typename Visitor, typename T>
void as_number(Visitor& visitor, const char* name, const char* option, T& value,
               const NumberRange& range) {
    double wide = static_cast<double>(value);
    visitor.number(name, option, wide, range);
    value = static_cast<T>(wide);
}

template <typename Visitor, typename Enum>
void as_word(Visitor& visitor, const char* name, const char* option, Enum& value,
             const std::vector<std::string>& known) {
    // What reads a file changes it. NOLINTNEXTLINE(performance-unnecessary-copy-initialization)
    std::string word = known.at(static_cast<std::size_t>(value));
    visitor.word(name, option, word, known);
    value = static_cast<Enum>(parse_name(name, word, known));
}

template <typename Visitor>
void visit_picture(Visitor& v, RenderSettings& s) {
    as_word(v, "renderer", "--renderer", s.renderer, renderer_names());
    as_word(v, "shading", "--shading", s.shading, shading_names());
    as_word(v, "gbuffer", "--gbuffer", s.gbuffer, gbuffer_names());
    as_word(v, "show", "--show", s.want.view, view_names());
    as_number(v, "exposure", "--exposure", s.exposure, {-126.0, 126.0});
    as_word(v, "tonemap", "--tonemap", s.tone_curve, tone_curve_names());
    as_number(v, "bloom", "--bloom", s.bloom, {0.0, 1.0});
    as_number(v, "ambient", "--ambient", s.ambient, {0.0, 1e6});
    as_number(v, "samples", "--samples", s.samples, {1, 64});
    as_number(v, "lights", "--lights", s.lights.count, {0, 1e7});
    as_number(v, "light_seed", "--light-seed", s.lights.seed, {0, 1e15});
    as_number(v, "light_radius", "--light-radius", s.lights.radius, {0.0, 1e6});
    as_number(v, "light_intensity", "--light-intensity", s.lights.intensity, {0.0, 1e9});
    as_number(v, "tiles_x", "--grid", s.grid.tiles_x, {1, 4096});
    as_number(v, "tiles_y", "--grid", s.grid.tiles_y, {1, 4096});
    as_number(v, "slices", "--grid", s.grid.slices_per_octave, {1, 64});
    as_number(v, "fine_slices", "--grid", s.grid.fine_per_octave, {1, 64});
    v.flag("count_useful", s.want.counts);
}

template <typename Visitor>
void visit_window(Visitor& v, ViewState& state) {
    v.flag("lights_move", state.lights_move);
    v.number("light_speed", "", state.light_speed, {0.01, 100.0});
    as_word(v, "camera_mode", "", state.camera_mode, {"fly", "orbit"});
    v.flag("adaptive", state.adaptive);
    v.number("target_ms", "", state.target_ms, {1.0, 1e4});
    v.number("scale", "", state.fixed_scale, {0.05, 1.0});
    v.flag("continuous", state.continuous);
    v.flag("vsync", state.vsync);
    v.flag("panel", state.show_panel);
    v.flag("overlay", state.show_overlay);
    v.flag("probe", state.probe);
    as_number(v, "bench_lights", "", state.bench_lights, {256, 1e6});
    as_number(v, "width", "--resolution", state.window_size[0], {64, 65536});
    as_number(v, "height", "--resolution", state.window_size[1], {64, 65536});
}

Json parse_file(const fs::path& file) {
    std::ifstream in(file);
    Json json = Json::parse(in, nullptr, false);
    if (!json.is_object()) throw Error("it is no JSON object");
    if (json.value("version", 0) != kVersion) throw Error("it is of another version");
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

ViewState load_view_state(const fs::path& file, const ViewState& state,
                          const std::function<bool(const std::string&)>& is_given) {
    std::error_code error;
    if (!fs::exists(file, error)) return state;
    try {
        const Json json = parse_file(file);
        Reader reader(json, is_given);
        ViewState out = state;
        visit_picture(reader, out.settings);
        visit_window(reader, out);
        return out;
    } catch (const std::exception& failure) {
        warn(file.string() + ": left out: " + failure.what());
        return state;
    }
}

void save_view_state(const fs::path& file, const ViewState& state) {
    if (file.empty()) return;
    Writer writer;
    ViewState copy = state;
    visit_picture(writer, copy.settings);
    visit_window(writer, copy);
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    write_whole_file(file, writer.json.dump(2) + "\n");
}

}  // namespace kilolux
