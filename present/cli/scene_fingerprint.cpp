// SPDX-License-Identifier: Apache-2.0
#include "present/cli/scene_fingerprint.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "host/base/error.h"
#include "host/scene/gltf/files.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

std::string file_line(const fs::path& file) {
    std::error_code error;
    const auto size = fs::file_size(file, error);
    if (error) return fmt::format("{} missing\n", file.string());
    const auto time = fs::last_write_time(file, error).time_since_epoch().count();
    return fmt::format("{} {} {}\n", file.string(), size, time);
}

// The JSON of a .gltf or .glb file; discarded if there is none.
nlohmann::json document_of(const fs::path& file) {
    try {
        return nlohmann::json::parse(read_gltf_text(file, file.string()).json, nullptr, false);
    } catch (const Error&) {
        return nlohmann::json::value_t::discarded;
    }
}

}  // namespace

std::string scene_fingerprint(const std::string& scene) {
    std::error_code error;
    const fs::path file = fs::weakly_canonical(scene, error);
    if (error || !fs::is_regular_file(file, error)) return scene;
    std::string text = file_line(file);
    const nlohmann::json document = document_of(file);
    for (const char* list : {"buffers", "images"}) {
        if (!document.is_object() || !document.contains(list)) continue;
        for (const nlohmann::json& entry : document[list]) {
            if (!entry.is_object() || !entry.contains("uri") || !entry["uri"].is_string()) continue;
            const std::string uri = entry["uri"];
            if (!uri.starts_with("data:"))
                text += file_line(file.parent_path() / percent_decoded(uri));
        }
    }
    return text;
}

}  // namespace kilolux
