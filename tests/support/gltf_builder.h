// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/base/system/temporary_folder.h"
#include "host/scene/gltf/load_scene.h"

namespace kilolux {

using Blob = std::vector<unsigned char>;

/// A new folder that goes with its owner.
using TempFolder = TemporaryFolder;

void write_file(const std::filesystem::path& file, const Blob& bytes);
void write_file(const std::filesystem::path& file, const std::string& text);

constexpr int kByte = 5120;
constexpr int kUnsignedByte = 5121;
constexpr int kShort = 5122;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr int kDouble = 5130;  // KHR_accessor_float64

/// The bytes of values in memory.
template <typename T>
Blob bytes_of(const std::vector<T>& values) {
    Blob bytes(values.size() * sizeof(T));
    if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

/// How an accessor reads its bytes.
struct Layout {
    int component_type = kFloat;
    std::string type = "VEC3";
    std::size_t count = 0;
    bool normalized = false;
    std::size_t stride = 0;  // 0: packed
};

/// A glTF file in the making: `root` is its JSON, which tests may change freely.
struct GltfBuilder {
    nlohmann::json root = {{"asset", {{"version", "2.0"}}}};
    Blob bin;

    /// Each returns the index of what it added.
    int add(const char* array, const nlohmann::json& element);
    int add_view(const Blob& bytes, std::size_t stride = 0);
    int add_accessor(const Blob& bytes, const Layout& layout);
    int add_floats(const std::string& type, const std::vector<float>& values);
    int add_indices(const std::vector<std::uint16_t>& values);
    int add_node(const nlohmann::json& node);  // also to the scene
    int add_texture(const Blob& encoded_image, const std::string& mime_type);
    nlohmann::json& primitive(std::size_t mesh = 0, std::size_t primitive = 0);

    std::string gltf() const;            // the buffer as a data URI
    Blob glb(bool padded = true) const;  // else the JSON chunk has one space more than it may have
};

/// One triangle (0,0,0) (1,0,0) (0,1,0) with normals +Z in one node.
GltfBuilder triangle_file();

/// A quad of two triangles in z = 0 from (0,0) to (1,1): u to the right, v down, normal map.
GltfBuilder quad_with_normal_map();

/// Loads the builder's file from an otherwise empty folder.
Scene load(const GltfBuilder& builder, const LoadOptions& options = {});

/// The message of the Error that loading throws; "" when it loads.
std::string load_error(const GltfBuilder& builder);
std::string load_error(const std::filesystem::path& file, const LoadOptions& options = {});

/// 8-bit pixels as the bytes of a file ("png", "jpeg", "targa", ...).
Blob encode_image(const std::string& format, int width, int channels, const Blob& pixels);

/// The same of 16 bits a channel.
Blob encode_deep_image(const std::string& format, int width, int channels,
                       const std::vector<std::uint16_t>& pixels);

/// Positions of an instance's vertices in the world.
std::vector<glm::dvec3> world_positions(const Scene& scene, std::size_t instance = 0);

/// The first problem of a scene's indices, sizes or numbers that the renderer relies on; "" for
/// none.
std::string scene_defect(const Scene& scene);

}  // namespace kilolux
