// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/document.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "host/base/error.h"
#include "host/scene/gltf/check.h"
#include "host/scene/gltf/extensions.h"
#include "host/scene/gltf/meshopt.h"
#include "host/scene/gltf/text.h"

namespace kilolux {
namespace {

using nlohmann::json;

// What a file may grow to in memory: enough for any honest one (instanced, skinned and compressed
// meshes included), small enough that a file of a few KiB cannot claim gigabytes.
constexpr std::uint64_t kBudgetFloorBytes = std::uint64_t{256} << 20;
constexpr std::uint64_t kBudgetPerFileByte = 1024;

bool is_meshopt_fallback(const json& buffer) {
    const json::json_pointer fallback("/extensions/EXT_meshopt_compression/fallback");
    return buffer.contains(fallback) && buffer.at(fallback).get<bool>();
}

Bytes read_buffer(const GltfDocument& document, const json& buffer, std::size_t index,
                  GltfText& text) {
    const std::string where = element_name("buffers", index);
    const auto length = buffer.at("byteLength").get<std::uint64_t>();
    Bytes bytes;
    if (buffer.contains("uri")) {
        bytes = read_uri(document.base, buffer.at("uri").get<std::string>(), where);
    } else if (index == 0 && text.has_binary) {
        bytes = std::move(text.binary);
    } else {
        if (is_meshopt_fallback(buffer)) return {};
        document.fail(where, "has neither a uri nor a GLB's BIN chunk");
    }
    if (bytes.size() < length) {
        document.fail(where, "byteLength is " + std::to_string(length) + ", the data hold " +
                                 std::to_string(bytes.size()) + " bytes");
    }
    bytes.resize(length);
    return bytes;
}

void read_buffers(GltfDocument& document, const json& root, GltfText& text) {
    std::uint64_t total = text.json.size();
    if (root.contains("buffers")) {
        const json& buffers = root.at("buffers");
        for (std::size_t i = 0; i < buffers.size(); ++i) {
            document.buffers.push_back(read_buffer(document, buffers[i], i, text));
            total += document.buffers.back().size();
        }
    }
    document.budget = std::make_unique<ByteBudget>(kBudgetFloorBytes + kBudgetPerFileByte * total);
}

// What tinygltf is given: without buffers and images, which it would read without our checks, and
// without what it refuses though it is valid.
json for_tinygltf(const json& root) {
    json out = root;
    out.erase("buffers");
    out.erase("images");
    const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
    if (out.contains(lights)) {
        for (json& light : out.at(lights)) {
            if (light.at("type") == "spot" && !light.contains("spot"))
                light["spot"] = json::object();
        }
    }
    if (!out.contains("meshes")) return out;
    for (json& mesh : out.at("meshes")) {
        if (!mesh.contains("primitives")) continue;
        for (json& primitive : mesh.at("primitives")) {
            // Their accessor has no buffer view; the triangles come out of the compressed data.
            if (primitive.contains(json::json_pointer("/extensions/KHR_draco_mesh_compression"))) {
                primitive.erase("indices");
            }
        }
    }
    return out;
}

std::string one_line(std::string text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
    for (char& c : text) {
        if (c == '\n') c = ' ';
    }
    return text;
}

void parse_model(GltfDocument& document, const json& root) {
    const std::string text = for_tinygltf(root).dump();
    if (text.size() > std::numeric_limits<unsigned>::max()) {
        document.fail("JSON", "is larger than 4 GiB");
    }
    std::string error;
    std::string warning;
    tinygltf::TinyGLTF reader;
    if (!reader.LoadASCIIFromString(&document.model, &error, &warning, text.data(),
                                    static_cast<unsigned>(text.size()), "")) {
        throw Error(document.base.file + ": " + one_line(error));
    }
    if (!root.contains("images")) return;
    for (const json& source : root.at("images")) {
        tinygltf::Image image;
        if (source.contains("name") && source.at("name").is_string())
            image.name = source.at("name");
        image.uri = source.value("uri", "");
        image.mimeType = source.value("mimeType", "");
        image.bufferView = source.value("bufferView", -1);
        document.model.images.push_back(std::move(image));
    }
}

std::span<const unsigned char> view_bytes(const GltfDocument& document, std::size_t index) {
    const tinygltf::BufferView& view = document.model.bufferViews[index];
    const Bytes& buffer = document.buffers[static_cast<std::size_t>(view.buffer)];
    if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset) {
        document.fail(element_name("bufferViews", index),
                      "byteOffset " + std::to_string(view.byteOffset) + " and byteLength " +
                          std::to_string(view.byteLength) + " leave buffers[" +
                          std::to_string(view.buffer) + "] of " + std::to_string(buffer.size()) +
                          " bytes");
    }
    return std::span(buffer).subspan(view.byteOffset, view.byteLength);
}

void resolve_views(GltfDocument& document) {
    const std::size_t count = document.model.bufferViews.size();
    document.decompressed.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        if (is_meshopt_compressed(document, i)) {
            document.decompressed[i] = decode_meshopt_view(document, i);
            document.views.emplace_back(document.decompressed[i]);
        } else {
            document.views.push_back(view_bytes(document, i));
        }
    }
}

void check_version(const GltfDocument& document, const json& asset) {
    for (const char* key : {"version", "minVersion"}) {
        if (!asset.contains(key)) continue;
        const std::string version = asset.at(key).get<std::string>();
        const bool known =
            key == std::string("version") ? version.starts_with("2.") : version == "2.0";
        if (!known) {
            throw Error(document.base.file + ": asset." + key + " is '" + shown_uri(version) +
                        "', must be 2.0; convert the file with gltf-transform");
        }
    }
}

}  // namespace

void ByteBudget::charge(std::uint64_t count, std::uint64_t bytes_each, const std::string& where) {
    const bool overflows = bytes_each != 0 && count > limit_ / bytes_each;
    const std::uint64_t bytes = overflows ? limit_ + 1 : count * bytes_each;
    std::uint64_t left = left_.load();
    do {
        if (bytes > left) {
            throw Error(where + ": claims " + std::to_string(count) + " elements of " +
                        std::to_string(bytes_each) + " bytes, more than a file of this size may " +
                        "decode to (" + std::to_string(limit_ >> 20) + " MiB)");
        }
    } while (!left_.compare_exchange_weak(left, left - bytes));
}

void GltfDocument::fail(const std::string& where, const std::string& what) const {
    throw Error(base.file + ": " + where + ": " + what);
}

std::string element_name(const char* array, std::size_t element) {
    return std::string(array) + "[" + std::to_string(element) + "]";
}

float to_float(double value) {
    if (std::abs(value) <= std::numeric_limits<float>::max()) return static_cast<float>(value);
    return std::copysign(std::numeric_limits<float>::infinity(),
                         static_cast<float>(value < 0 ? -1 : 1));
}

GltfDocument load_gltf_document(const std::filesystem::path& file, const LoadOptions& options) {
    GltfDocument document;
    document.options = options;
    document.base = {file.string(), file.parent_path(), options.allow_outside_paths};
    GltfText text = read_gltf_text(file, document.base.file);
    const json root = parse_gltf_json(text.json, document.base.file);
    check_version(document, root.at("asset"));
    read_buffers(document, root, text);
    parse_model(document, root);
    check_extensions(document);
    resolve_views(document);
    return document;
}

}  // namespace kilolux
