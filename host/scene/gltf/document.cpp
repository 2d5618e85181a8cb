// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/document.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "host/base/log.h"
#include "host/base/system/memory.h"
#include "host/scene/gltf/check.h"
#include "host/scene/gltf/choices.h"
#include "host/scene/gltf/extensions.h"
#include "host/scene/gltf/mesh/meshopt.h"
#include "host/scene/gltf/used_parts.h"

namespace kilolux {
namespace {

using nlohmann::json;

// Bounds of the memory that accessors decode to: enough for real files with instanced, skinned and
// compressed meshes, small enough that a file of a few KiB cannot claim gigabytes.
constexpr std::uint64_t kBudgetFloorBytes = std::uint64_t{256} << 20;
constexpr std::uint64_t kBudgetPerFileByte = 1024;

// Charges the budget for a part of the file, and keeps the charge.
BeforeBytes charging(const GltfDocument& document, const std::string& where) {
    return [&document, where](std::uint64_t bytes) {
        document.budget->charge_memory(bytes, document.base.file + ": " + where);
    };
}

std::optional<ByteSpan> read_buffer(GltfDocument& document, const json& buffer, std::size_t index,
                                    const GltfText& text) {
    const std::string where = element_name("buffers", index);
    const auto length = buffer.at("byteLength").get<std::uint64_t>();
    const bool has_uri = buffer.contains("uri");
    if (!has_uri && (index > 0 || !text.has_binary)) return std::nullopt;
    ByteSpan bytes = text.binary;
    if (has_uri) {
        const auto& uri = buffer.at("uri").get_ref<const std::string&>();
        document.owned.push_back(read_uri(document.base, uri, where, charging(document, where)));
        bytes = document.owned.back();
    }
    if (bytes.size() < length) {
        document.fail(where, "byteLength is {}, the data hold {} bytes", length, bytes.size());
    }
    return bytes.first(length);
}

// Takes the buffers out of the JSON.
void read_buffers(GltfDocument& document, json& root, const std::vector<bool>& used,
                  const GltfText& text) {
    std::uint64_t total = text.json.size();
    if (root.contains("buffers")) {
        json& buffers = root.at("buffers");
        for (std::size_t i = 0; i < buffers.size(); ++i) {
            document.buffers.emplace_back();
            if (used[i]) document.buffers.back() = read_buffer(document, buffers[i], i, text);
            buffers[i] = nullptr;
            total += document.buffers.back().value_or(ByteSpan{}).size();
        }
        root.erase("buffers");
    }
    document.budget->allow_for_file(total);
}

// Changes the JSON where tinygltf refuses or loses parts of valid files. It requires a buffer view
// of each accessor of indices, so these are taken out: returns them by primitive, -1 for none.
std::vector<int> adapt_to_tinygltf(json& root) {
    const auto each = [&root](const char* array, const auto& change) {
        const json::json_pointer place(array);
        if (!root.contains(place)) return;
        for (json& element : root.at(place)) change(element);
    };
    // tinygltf drops empty objects, and the array's indices with them.
    each("/extensions/EXT_lights_ies/lights", [](json& light) { light.emplace("name", ""); });
    std::vector<int> indices;
    each("/meshes", [&indices](json& mesh) {
        if (!mesh.contains("primitives")) return;
        for (json& primitive : mesh.at("primitives")) {
            indices.push_back(primitive.value("indices", -1));
            primitive.erase("indices");
        }
    });
    return indices;
}

std::string one_line(std::string text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
    for (char& c : text) {
        if (c == '\n') c = ' ';
    }
    return text;
}

void add_images(GltfDocument& document, std::vector<json>& images) {
    for (json& source : images) {
        tinygltf::Image image;
        if (source.contains("name") && source.at("name").is_string())
            image.name = source.at("name");
        if (source.contains("uri")) image.uri = std::move(source.at("uri").get_ref<std::string&>());
        image.mimeType = source.value("mimeType", "");
        image.bufferView = source.value("bufferView", -1);
        document.model.images.push_back(std::move(image));
    }
}

// Moves an array out of the file.
std::vector<json> take_array(json& root, const char* name) {
    std::vector<json> out;
    if (root.contains(name)) out = std::move(root.at(name).get_ref<json::array_t&>());
    root.erase(name);
    return out;
}

// Reads all but buffers and images, which tinygltf would read without our checks, materials
// and lights.
void parse_model(GltfDocument& document, json root) {
    std::vector<json> images = take_array(root, "images");
    document.materials = take_array(root, "materials");
    const json::json_pointer punctual("/extensions/KHR_lights_punctual");
    if (root.contains(punctual)) document.lights = take_array(root.at(punctual), "lights");
    const std::vector<int> indices = adapt_to_tinygltf(root);
    const std::string text = root.dump();
    if (text.size() > std::numeric_limits<unsigned>::max()) {
        document.fail("JSON", "is larger than 4 GiB");
    }
    std::string error;
    std::string warning;
    tinygltf::TinyGLTF reader;
    if (!reader.LoadASCIIFromString(&document.model, &error, &warning, text.data(),
                                    static_cast<unsigned>(text.size()), "")) {
        document.fail("JSON", "is refused by tinygltf: {}", one_line(error));
    }
    auto next = indices.begin();
    for (tinygltf::Mesh& mesh : document.model.meshes) {
        for (tinygltf::Primitive& primitive : mesh.primitives) primitive.indices = *next++;
    }
    add_images(document, images);
}

ByteSpan view_bytes(const GltfDocument& document, std::size_t index) {
    const tinygltf::BufferView& view = document.model.bufferViews[index];
    const std::string where = element_name("bufferViews", index);
    const ByteSpan buffer = bytes_of_buffer(document, static_cast<std::size_t>(view.buffer), where);
    if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset) {
        document.fail(where, "byteOffset {} and byteLength {} leave buffers[{}] of {} bytes",
                      view.byteOffset, view.byteLength, view.buffer, buffer.size());
    }
    return buffer.subspan(view.byteOffset, view.byteLength);
}

void resolve_views(GltfDocument& document, const std::vector<bool>& used) {
    for (std::size_t i = 0; i < document.model.bufferViews.size(); ++i) {
        if (!used[i]) {
            document.views.emplace_back();
        } else if (is_meshopt_compressed(document, i)) {
            document.owned.push_back(decode_meshopt_view(document, i));
            document.views.emplace_back(document.owned.back());
        } else {
            document.views.push_back(view_bytes(document, i));
        }
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

MemoryCharge LoadBudget::borrow_memory(std::uint64_t bytes, const std::string& where) {
    charge_memory(bytes, where);
    return MemoryCharge(this, ReleaseMemory{bytes});
}

void ReleaseMemory::operator()(LoadBudget* budget) const { budget->release_memory(bytes); }

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
    FileBytes out;
    out.owned = read_uri(document.base, uri, where, [&](std::uint64_t bytes) {
        out.charge = document.budget->borrow_memory(bytes, document.base.file + ": " + where);
    });
    out.bytes = out.owned;
    return out;
}

ByteSpan bytes_of_buffer(const GltfDocument& document, std::size_t buffer,
                         const std::string& reader) {
    if (!document.buffers[buffer]) {
        document.fail(element_name("buffers", buffer),
                      "has neither a uri nor a GLB's BIN chunk, and {} reads it", reader);
    }
    return *document.buffers[buffer];
}

const json* find_member(const json& object, std::string_view path) {
    const std::size_t end = std::min(path.find('.'), path.size());
    const auto member = object.find(path.substr(0, end));
    if (member == object.end()) return nullptr;
    return end == path.size() ? &*member : find_member(*member, path.substr(end + 1));
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
    const auto charge_file = [&document](std::uint64_t bytes) {
        document.budget->charge_memory(bytes, document.base.file);
    };
    GltfText text = read_gltf_text(file, document.base.file, charge_file);
    const MemoryCharge values =
        document.budget->borrow_memory(text.json.size(), document.base.file + ": JSON");
    auto [root, broken_animations] = parse_gltf_json(text.json, document.base.file);
    document.broken_animations = std::move(broken_animations);
    const UsedParts used = used_parts(root);
    read_buffers(document, root, used.buffers, text);
    if (text.has_binary) {
        document.owned.push_back(std::move(text.file));
    } else {
        document.budget->release_memory(text.file.size());
        text = {};
    }
    parse_model(document, std::move(root));
    check_extensions(document);
    apply_variant(document);
    document.clips = choose_clips(document);
    resolve_views(document, used.views);
    return document;
}

}  // namespace kilolux
