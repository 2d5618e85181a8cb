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
#include "host/scene/gltf/json/animated_property.h"
#include "host/scene/gltf/json/parse_model.h"
#include "host/scene/gltf/json/used_parts.h"
#include "host/scene/gltf/lights_cameras.h"
#include "host/scene/gltf/mesh/meshopt.h"

namespace kilolux {
namespace {

using nlohmann::json;

// Charges the budget for a part of the file, and keeps the charge.
BeforeBytes charging(const GltfDocument& document, const std::string& where) {
    return [&document, where](std::uint64_t bytes) {
        document.budget->charge_memory(bytes, document.base.file + ": " + where);
    };
}

// The bytes that a uri of the JSON names.
FileBytes read_bytes(const GltfDocument& document, const std::string& uri, const std::string& where,
                     const BeforeBytes& before) {
    FileBytes out;
    if (const DataUri* data = find_data_uri(document.data, uri)) {
        if (!data->broken.empty()) document.fail(where, "data URI {}", data->broken);
        out.bytes = data->bytes;
    } else {
        out.owned = read_uri(document.base, uri, where, before);
        out.bytes = out.owned;
    }
    return out;
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
        FileBytes file = read_bytes(document, uri, where, charging(document, where));
        bytes = file.bytes;
        document.owned.push_back(std::move(file.owned));
    }
    if (bytes.size() < length) {
        document.fail(where, "byteLength is {}, the data hold {} bytes", length, bytes.size());
    }
    return bytes.first(length);
}

// Takes the buffers out of the JSON, which has `total` bytes, and reads those that are used.
void read_buffers(GltfDocument& document, json& root, const std::vector<bool>& used,
                  const GltfText& text, std::uint64_t total) {
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

}  // namespace

void GltfDocument::leave_out(const std::string& what) const {
    if (options.strict) throw Error(base.file + ": --strict: " + what);
    warn(base.file + ": " + what);
}

FileBytes read_source(const GltfDocument& document, const std::string& uri, int view,
                      const std::string& where) {
    if (uri.empty()) return {{}, document.views[static_cast<std::size_t>(view)]};
    MemoryCharge charge;
    FileBytes out = read_bytes(document, uri, where, [&](std::uint64_t bytes) {
        charge = document.budget->borrow_memory(bytes, document.base.file + ": " + where);
    });
    out.charge = std::move(charge);
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
    document.budget = std::make_shared<LoadBudget>(loading_limit(options.max_memory_bytes));
    const auto charge_file = [&document](std::uint64_t bytes) {
        document.budget->charge_memory(bytes, document.base.file);
    };
    GltfText text = read_gltf_text(file, document.base.file, charge_file);
    const std::uint64_t json_bytes = text.json.size();
    JsonText surveyed = survey_json(text.file, text.json, charge_file);
    const std::uint64_t parsed_bytes = surveyed.parsed_bytes;
    document.budget->charge_memory(parsed_bytes, document.base.file + ": JSON");
    auto [root, broken_animations] = parse_gltf_json(surveyed, document.base.file);
    document.broken_animations = std::move(broken_animations);
    document.data = std::move(surveyed.data);
    document.budget->release_memory(surveyed.short_text.size());
    surveyed = {};
    if (text.has_binary || !document.data.empty()) {
        document.owned.push_back(std::move(text.file));
    } else {
        document.budget->release_memory(text.file.size());
        text = {};
    }
    const UsedParts used = used_parts(root);
    read_buffers(document, root, used.buffers, text, json_bytes);
    parse_model(document, std::move(root), parsed_bytes);
    check_extensions(document);
    report_lights(document);
    apply_variant(document);
    document.clips = choose_clips(document);
    document.animated = list_animated_properties(document);
    resolve_views(document, used.views);
    return document;
}

}  // namespace kilolux
