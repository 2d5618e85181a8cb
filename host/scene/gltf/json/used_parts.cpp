// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/json/used_parts.h"

#include "host/scene/gltf/document.h"
#include "host/scene/gltf/mesh/meshopt.h"

namespace kilolux {
namespace {

using nlohmann::json;

void mark(std::vector<bool>& used, const json& object, const char* member) {
    const auto index = object.find(member);
    if (index == object.end() || !index->is_number_unsigned()) return;
    const auto place = index->get<std::size_t>();
    if (place < used.size()) used[place] = true;
}

// Marks the views that an object or anything in it names.
void mark_views(std::vector<bool>& used, const json& value) {
    if (value.is_object()) mark(used, value, "bufferView");
    for (const json& part : value) {
        if (part.is_structured()) mark_views(used, part);
    }
}

}  // namespace

UsedParts used_parts(const json& root) {
    const auto views = root.value("bufferViews", json::array());
    const auto buffers = root.find("buffers");
    UsedParts out;
    out.views.resize(views.size());
    out.buffers.resize(buffers == root.end() ? 0 : buffers->size());
    for (const char* part : {"accessors", "images", "meshes", "extensions"}) {
        if (root.contains(part)) mark_views(out.views, root.at(part));
    }
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (!out.views[i]) continue;
        const json* source = &views[i];
        for (const std::string_view name : kMeshoptExtensions) {
            const json* found = find_member(views[i], "extensions." + std::string(name));
            if (found != nullptr) source = found;
        }
        mark(out.buffers, *source, "buffer");
    }
    return out;
}

}  // namespace kilolux
