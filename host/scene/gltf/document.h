// SPDX-License-Identifier: Apache-2.0
#pragma once

// The library is built without stb; images go through OpenImageIO.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <fmt/core.h>
#include <tiny_gltf.h>

#include <array>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/base/error.h"
#include "host/scene/gltf/files.h"
#include "host/scene/gltf/json/json_text.h"
#include "host/scene/gltf/load_budget.h"
#include "host/scene/gltf/load_scene.h"
#include "host/scene/lights/light_kinds.h"

namespace kilolux {

/// A property that a channel of a playing animation drives.
struct AnimatedProperty {
    std::size_t clip = 0;     // index of the animation
    std::size_t channel = 0;  // within it
    std::string array{};      // "nodes", "extensions.KHR_lights_punctual.lights"
    std::size_t element = 0;
    std::string path{};      // within the element: "pbrMetallicRoughness.baseColorFactor"
    std::size_t length = 0;  // numbers; 0: as many as the file says
};

/// A glTF file whose JSON is checked and whose buffers are in memory.
///
/// Every index of `model` is in range except those that are relative to another element (an
/// animation's samplers, a skin's joints in JOINTS_n, vertex indices).
struct GltfDocument {
    UriBase base;
    LoadOptions options;
    // Without buffers, materials, cameras and lights; images keep uri, bufferView and mimeType
    // only.
    tinygltf::Model model;
    std::vector<nlohmann::json> materials;
    std::vector<nlohmann::json> cameras;
    std::array<std::vector<nlohmann::json>, kLightExtensions.size()> lights;
    std::vector<std::optional<ByteSpan>> buffers;  // none: a placeholder without data, or not used
    std::vector<ByteSpan> views;                   // one per buffer view, decompressed
    std::vector<Bytes> owned;                      // what buffers, views and data point into
    std::vector<DataUri> data;                     // the JSON's long data URIs
    std::vector<std::size_t> clips;                // animations that play, first one first
    std::vector<AnimatedProperty> animated;        // by them
    std::map<std::size_t, std::string> broken_animations;  // why, by index; empty in `model`
    std::shared_ptr<LoadBudget> budget;
    // Key times that apply_animations() has read, by accessor.
    mutable std::map<int, std::vector<float>> key_times;

    /// Reports a part of the file that the picture lacks or shows otherwise: as a warning, or as an
    /// Error where the options are strict.
    void leave_out(const std::string& what) const;

    /// Throws Error "<file>: <where>: <what>", formatted by {fmt}.
    template <typename... Args>
    [[noreturn]] void fail(const std::string& where, fmt::format_string<Args...> what,
                           Args&&... args) const {
        throw Error(base.file + ": " + where + ": " +
                    fmt::format(what, std::forward<Args>(args)...));
    }
};

/// Bytes that a part of a file refers to.
struct FileBytes {
    Bytes owned;  // of a uri
    ByteSpan bytes;
    MemoryCharge charge{};  // for `owned`
};

/// The bytes that a uri names, or those of a buffer view where the uri is empty. Throws as
/// read_uri() does.
FileBytes read_source(const GltfDocument& document, const std::string& uri, int view,
                      const std::string& where);

/// A buffer's bytes for the part of the file that `reader` names. Throws Error for a placeholder.
ByteSpan bytes_of_buffer(const GltfDocument& document, std::size_t buffer,
                         const std::string& reader);

/// The member of a JSON object that a path of names leads to ("extensions.KHR_x.factor"), or null.
const nlohmann::json* find_member(const nlohmann::json& object, std::string_view path);

/// "accessors[7]".
std::string element_name(const char* array, std::size_t element);

/// A double of the file as a float; beyond its range infinite.
float to_float(double value);

/// Reads and checks a file up to, not including, the contents of its accessors and images.
GltfDocument load_gltf_document(const std::filesystem::path& file, const LoadOptions& options);

}  // namespace kilolux
