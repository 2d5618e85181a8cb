// SPDX-License-Identifier: Apache-2.0
#include "present/cli/conditions.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/base/version.h"
#include "host/scene/gltf/files.h"
#include "present/cli/commit.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool is_file(const fs::path& file) {
    std::error_code error;
    return fs::is_regular_file(file, error);
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
    return fmt::format("{} {} {}\n", file.filename().string(), size, hash_text(hashes));
}

// The JSON of a .gltf or .glb file; discarded if there is none. Levels below those of any glTF
// object are left out.
nlohmann::json document_of(const fs::path& file) {
    constexpr int kLevels = 64;
    const auto is_kept = [](int level, nlohmann::json::parse_event_t, nlohmann::json&) {
        return level < kLevels;
    };
    try {
        return nlohmann::json::parse(read_gltf_text(file, file.string()).json, is_kept, false);
    } catch (const Error&) {
        return nlohmann::json::value_t::discarded;
    }
}

// Lines of all files that a glTF document names.
std::string named_files(const nlohmann::json& document, const fs::path& folder) {
    if (!document.is_structured()) return "";
    std::string out;
    for (const auto& [name, value] : document.items()) {
        if (name != "uri" || !value.is_string()) {
            out += named_files(value, folder);
            continue;
        }
        const std::string uri = value;
        if (is_data_uri(uri)) continue;
        out += file_line(folder / (is_file(folder / uri) ? uri : percent_decoded(uri)));
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

std::string input_content(const SharedOptions& shared, const std::vector<fs::path>& more) {
    std::string text;
    if (is_file(shared.scene)) {
        const fs::path file = fs::canonical(shared.scene);
        text = file_line(file) + named_files(document_of(file), file.parent_path());
    }
    std::vector<fs::path> others = more;
    others.insert(others.begin(), shared.environment);
    for (const fs::path& file : others) {
        if (is_file(file)) text += file_line(file);
    }
    return text.empty() ? "" : hash_text(text);
}

std::string scene_content(const SharedOptions& shared) {
    const std::string files = input_content(shared);
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
            const bool names_file = setting.kind == SettingKind::text && is_file(setting.show());
            out[setting.word()] = names_file ? Json(fs::path(setting.show()).filename().string())
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
