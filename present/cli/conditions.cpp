// SPDX-License-Identifier: Apache-2.0
#include "present/cli/conditions.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/base/system/memory.h"
#include "host/base/version.h"
#include "host/scene/gltf/json/json_text.h"
#include "host/scene/gltf/load_budget.h"
#include "present/cli/commit.h"
#include "present/cli/scene_choice.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool is_file(const fs::path& file) {
    std::error_code error;
    return fs::is_regular_file(file, error);
}

bool names_file(const Setting& setting) {
    return setting.kind == SettingKind::input_file &&
           std::ranges::count(setting.words, setting.show()) == 0 && is_file(setting.show());
}

// Name, size and hash of a file, read piece by piece.
std::string file_line(const fs::path& file) {
    constexpr std::size_t kPiece = 1 << 20;
    std::ifstream in;
    if (is_file(file)) in.open(file, std::ios::binary);  // a pipe or a device may have no end
    if (!in.is_open()) return file.filename().string() + " missing\n";
    std::string piece(kPiece, '\0'), hashes;
    std::uint64_t size = 0;
    do {
        in.read(piece.data(), kPiece);
        const std::string_view seen(piece.data(), static_cast<std::size_t>(in.gcount()));
        size += seen.size();
        hashes += hash_text(seen);
    } while (in);
    if (in.bad()) throw Error(file.string() + ": cannot be read to its end");
    return fmt::format("{} {} {}\n", file.filename().string(), size, hash_text(hashes));
}

// Collects the uris of a glTF file that name files, in the file's order.
class UriReader : public nlohmann::json_sax<nlohmann::json> {
 public:
    const std::vector<std::string>& uris() const { return uris_; }

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return true; }
    bool end_object() override { return true; }
    bool start_array(std::size_t) override { return of_uri_ = false, true; }
    bool end_array() override { return true; }
    bool key(string_t& name) override {
        of_uri_ = name == "uri";
        return true;
    }
    bool string(string_t& value) override {
        if (of_uri_ && !is_data_uri(value)) uris_.push_back(std::move(value));
        return true;
    }
    bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception&) override {
        uris_.clear();
        return false;
    }

 private:
    bool of_uri_ = false;  // the last key was "uri"
    std::vector<std::string> uris_;
};

// Lines of all files that a .gltf or .glb file names; none if it is no such file.
std::string named_files(const fs::path& file, std::uint64_t max_memory_bytes) {
    UriReader named;
    LoadBudget budget(loading_limit(max_memory_bytes));
    const auto charge = [&](std::uint64_t bytes) { budget.charge_memory(bytes, file.string()); };
    try {
        Bytes bytes = read_gltf_json(file, charge);
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        const JsonText json = survey_json(bytes, text, charge);
        if (json.depth <= kDeepestJson) nlohmann::json::sax_parse(json.text, &named);
    } catch (const MemoryError&) {
        throw;
    } catch (const Error&) {
        return "";
    }
    std::string out;
    for (const std::string& uri : named.uris()) {
        const fs::path folder = file.parent_path();
        out += file_line(folder / relative_path_of(folder, uri));
    }
    return out;
}

Json camera_json(const Camera& camera) {
    const auto vector = [](const glm::dvec3& v) { return Json{v.x, v.y, v.z}; };
    Json out = {{"position", vector(camera.position)},
                {"backward", vector(camera.world_from_view[2])},
                {"up", vector(camera.world_from_view[1])},
                {"orthographic", camera.orthographic}};
    out[camera.orthographic ? "half_height_m" : "y_fov_rad"] =
        camera.orthographic ? camera.y_extent : camera.y_fov;
    return out;
}

}  // namespace

std::string input_content(const SharedOptions& shared, const std::vector<Setting>& settings,
                          const std::vector<fs::path>& more) {
    std::string text;
    for (const Setting& setting : settings) {
        if (setting.text.effect.changes != Changes::picture || !names_file(setting)) continue;
        const std::string name = setting.show();
        if (name == shared.scene) check_scene(name);  // not to read what is no scene
        const fs::path file = fs::canonical(name);
        text += file_line(file);
        if (name == shared.scene) text += named_files(file, shared.settings.max_memory_bytes);
    }
    for (const fs::path& file : more) {
        if (is_file(file)) text += file_line(file);
    }
    return text.empty() ? "" : hash_text(text);
}

std::string scene_content(const SharedOptions& shared) {
    SharedOptions noted = shared;
    const std::string files = input_content(shared, settings_of(noted));
    return files.empty() ? shared.scene : files;
}

Json value_json(const Setting& setting) {
    const std::string text = setting.show();
    if (setting.kind == SettingKind::flag) return text == "true";
    const bool is_number =
        setting.kind == SettingKind::number || setting.kind == SettingKind::count;
    const Json number = is_number ? Json::parse(text, nullptr, false) : Json();
    return number.is_number() ? number : Json(text);
}

Json settings_json(SharedOptions shared) {
    Json out;
    for (const Setting& setting : settings_of(shared)) {
        if (setting.text.effect.changes != Changes::neither) {
            // A file counts by its content: see scene_content().
            out[setting.word()] = names_file(setting)
                                      ? Json(fs::path(setting.show()).filename().string())
                                      : value_json(setting);
        }
    }
    return out;
}

Json program_json() { return {{"version", version()}, {"commit", commit()}}; }

Json conditions_json(const SharedOptions& shared, const Scene& scene, const Camera& camera) {
    return {{"program", program_json()},
            {"scene",
             {{"name",
               is_file(shared.scene) ? fs::path(shared.scene).filename().string() : shared.scene},
              {"content", scene_content(shared)},
              {"triangles", triangle_count(scene)},
              {"lights", scene.lights.size()}}},
            {"camera", camera_json(camera)},
            {"settings", settings_json(shared)}};
}

std::string first_difference(const Json& was, const Json& is) {
    const Json before = was.flatten(), now = is.flatten();
    const auto text = [](const Json& values, const std::string& path) {
        return values.contains(path) ? values[path].dump() : "missing";
    };
    for (const Json* values : {&now, &before}) {
        for (const auto& [path, value] : values->items()) {
            const std::string former = text(before, path), present = text(now, path);
            if (former == present) continue;
            return fmt::format("{} was {}, is {}", path.substr(1), former, present);
        }
    }
    return "";
}

}  // namespace kilolux
