// SPDX-License-Identifier: Apache-2.0
#include "present/cli/scene_fingerprint.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

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

// The JSON of a .gltf, or of a .glb's first chunk (glTF 2.0, 4.4); discarded if there is none.
nlohmann::json document_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::string text(std::istreambuf_iterator<char>(in), {});
    constexpr std::size_t kHeader = 20, kLength = 12;
    if (text.starts_with("glTF") && text.size() > kHeader) {
        std::uint32_t length = 0;
        std::memcpy(&length, text.data() + kLength, sizeof length);
        text = text.substr(kHeader, length);
    }
    return nlohmann::json::parse(text, nullptr, false);
}

int hex_digit(char c) {
    const std::string digits = "0123456789abcdef";
    const auto place = digits.find(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
    return place == std::string::npos ? 0 : static_cast<int>(place);
}

std::string percent_decoded(const std::string& uri) {
    std::string out;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool code = uri[i] == '%' && i + 2 < uri.size();
        out +=
            code ? static_cast<char>(16 * hex_digit(uri[i + 1]) + hex_digit(uri[i + 2])) : uri[i];
        i += code ? 2 : 0;
    }
    return out;
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
