// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/document.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "host/base/log.h"
#include "host/base/memory.h"
#include "host/scene/gltf/check.h"
#include "host/scene/gltf/choices.h"
#include "host/scene/gltf/extensions.h"
#include "host/scene/gltf/mesh/meshopt.h"

namespace kilolux {
namespace {

using nlohmann::json;

// What accessors may decode to: enough for real files with instanced, skinned and compressed
// meshes, small enough that a file of a few KiB cannot claim gigabytes.
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
    const bool has_data = buffer.contains("uri") || (index == 0 && text.has_binary);
    if (!has_data && is_meshopt_fallback(buffer)) return {};
    if (!has_data) document.fail(where, "has neither a uri nor a GLB's BIN chunk");
    document.budget->charge_memory(length, document.base.file + ": " + where);
    Bytes bytes;
    if (buffer.contains("uri")) {
        bytes = read_uri(document.base, buffer.at("uri").get<std::string>(), where);
    } else {
        bytes = std::move(text.binary);
    }
    if (bytes.size() < length) {
        document.fail(where, "byteLength is {}, the data hold {} bytes", length, bytes.size());
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
    document.budget->allow_for_file(total);
}

// The JSON for tinygltf: without buffers and images, which it would read without our checks, and
// changed where it refuses valid files.
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
    // It drops empty objects, and the array's indices with them.
    const json::json_pointer profiles("/extensions/EXT_lights_ies/lights");
    if (out.contains(profiles)) {
        for (json& light : out.at(profiles)) light.emplace("name", "");
    }
    if (!out.contains("meshes")) return out;
    for (json& mesh : out.at("meshes")) {
        if (!mesh.contains("primitives")) continue;
        for (json& primitive : mesh.at("primitives")) {
            // The accessor has no buffer view; the triangles are in the compressed data.
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
                      "byteOffset {} and byteLength {} leave buffers[{}] of {} bytes",
                      view.byteOffset, view.byteLength, view.buffer, buffer.size());
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
        if (known) continue;
        const char* hint =
            version.starts_with("1.") ? "; gltf-pipeline -i old.gltf -o new.gltf converts it" : "";
        throw Error(fmt::format("{}: asset.{} is '{}', must be 2.0{}", document.base.file, key,
                                shown_uri(version), hint));
    }
}

// Takes bytes from a budget shared with other threads; false when fewer are left.
bool take(std::atomic<std::uint64_t>& left, std::uint64_t bytes) {
    std::uint64_t seen = left.load();
    do {
        if (bytes > seen) return false;
    } while (!left.compare_exchange_weak(seen, seen - bytes));
    return true;
}

}  // namespace

LoadBudget::LoadBudget(std::uint64_t memory_bytes)
    : memory_limit_(memory_bytes), memory_left_(memory_bytes) {}

void LoadBudget::allow_for_file(std::uint64_t file_bytes) {
    decode_left_ = decode_limit_ = kBudgetFloorBytes + kBudgetPerFileByte * file_bytes;
}

void LoadBudget::charge(std::uint64_t count, std::uint64_t bytes_each, const std::string& where) {
    const bool overflows = bytes_each != 0 && count > decode_limit_ / bytes_each;
    if (overflows || !take(decode_left_, count * bytes_each)) {
        throw Error(
            fmt::format("{}: claims {} elements of {} bytes, more than a file of this size "
                        "may decode to ({})",
                        where, count, bytes_each, mebibytes(decode_limit_)));
    }
    charge_memory(count * bytes_each, where);
}

void LoadBudget::charge_memory(std::uint64_t bytes, const std::string& where) {
    if (take(memory_left_, bytes)) return;
    throw Error(
        fmt::format("{}: needs {} of memory, {} MiB of {} for buffers, images and meshes are "
                    "left (--max-memory)",
                    where, mebibytes(bytes), memory_left_ >> 20, mebibytes(memory_limit_)));
}

void LoadBudget::refill() {
    memory_left_ += decode_limit_ - decode_left_;
    decode_left_ = decode_limit_;
}

void GltfDocument::leave_out(const std::string& what) const {
    if (options.strict) throw Error(base.file + ": --strict: " + what);
    warn(base.file + ": " + what);
}

FileBytes read_source(const GltfDocument& document, const std::string& uri, int view,
                      const std::string& where) {
    if (uri.empty()) return {{}, document.views[static_cast<std::size_t>(view)]};
    FileBytes out{read_uri(document.base, uri, where), {}};
    out.bytes = out.owned;
    return out;
}

std::string element_name(const char* array, std::size_t element) {
    return fmt::format("{}[{}]", array, element);
}

float to_float(double value) {
    using Limits = std::numeric_limits<float>;
    if (std::abs(value) <= Limits::max()) return static_cast<float>(value);
    return value < 0 ? -Limits::infinity() : Limits::infinity();
}

GltfDocument load_gltf_document(const std::filesystem::path& file, const LoadOptions& options) {
    GltfDocument document;
    document.options = options;
    document.base = {file.string(), file.parent_path(), options.allow_outside_paths};
    const std::uint64_t memory = options.max_memory_bytes;
    document.budget =
        std::make_unique<LoadBudget>(memory > 0 ? memory : available_memory_bytes() / 2);
    GltfText text = read_gltf_text(file, document.base.file);
    const json root = parse_gltf_json(text.json, document.base.file);
    check_version(document, root.at("asset"));
    read_buffers(document, root, text);
    parse_model(document, root);
    check_extensions(document);
    apply_variant(document);
    document.clips = choose_clips(document);
    resolve_views(document);
    return document;
}

}  // namespace kilolux
