// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/extensions.h"

#include <algorithm>
#include <array>

namespace kilolux {
namespace {

constexpr std::array<std::string_view, 14> kSupported = {
    "KHR_lights_punctual",     "KHR_texture_transform",
    "KHR_mesh_quantization",   "KHR_materials_emissive_strength",
    "KHR_materials_unlit",     "KHR_materials_ior",
    "KHR_materials_specular",  "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_variants",  "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression", "KHR_draco_mesh_compression",
    "EXT_texture_webp",        "EXT_lights_ies",
};

// Say nothing of the picture.
constexpr std::array<std::string_view, 3> kMetadata = {"KHR_xmp_json_ld", "KHR_xmp",
                                                       "EXT_structural_metadata"};

// Extensions that a picture can do without, and how that shows.
struct Dispensable {
    std::string_view name;
    std::string_view shows;
};

constexpr std::array kDispensable = {
    Dispensable{"KHR_materials_transmission", "glass looks opaque"},
    Dispensable{"KHR_materials_volume", "thick glass does not tint light"},
    Dispensable{"KHR_materials_volume_scatter", "no light scatters below surfaces"},
    Dispensable{"KHR_materials_diffuse_transmission", "leaves and paper let no light through"},
    Dispensable{"KHR_materials_dispersion", "glass shows no rainbow"},
    Dispensable{"KHR_materials_clearcoat", "coats have no highlight of their own"},
    Dispensable{"KHR_materials_sheen", "cloth has no sheen"},
    Dispensable{"KHR_materials_iridescence", "thin films show no colours"},
    Dispensable{"KHR_materials_anisotropy", "brushed metal has round highlights"},
    Dispensable{"KHR_animation_pointer", "what it animates stands still"},
    Dispensable{"KHR_node_visibility", "hidden nodes are drawn"},
    Dispensable{"MSFT_lod", "the finest level is drawn"},
};

template <typename List>
bool contains(const List& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
}

const Dispensable* find_dispensable(const std::string& name) {
    const auto found = std::find_if(kDispensable.begin(), kDispensable.end(),
                                    [&](const Dispensable& d) { return d.name == name; });
    return found == kDispensable.end() ? nullptr : &*found;
}

// Extensions that a file uses or requires, each once, in the file's order.
std::vector<std::string> named_extensions(const tinygltf::Model& model) {
    std::vector<std::string> names;
    for (const auto* list : {&model.extensionsRequired, &model.extensionsUsed}) {
        for (const std::string& name : *list) {
            if (!contains(names, name)) names.push_back(name);
        }
    }
    return names;
}

}  // namespace

void check_extensions(const GltfDocument& document) {
    const tinygltf::Model& model = document.model;
    std::string left_out;
    for (const std::string& name : named_extensions(model)) {
        if (contains(kSupported, name) || contains(kMetadata, name)) continue;
        const Dispensable* dispensable = find_dispensable(name);
        if (dispensable == nullptr && contains(model.extensionsRequired, name)) {
            const char* hint = name == "KHR_texture_basisu"
                                   ? "; gltf-transform ktxdecompress in.glb out.glb decodes it"
                                   : "";
            document.fail("extensionsRequired", "the file needs '{}', which is not supported{}",
                          shown_uri(name), hint);
        }
        const std::string_view shows =
            dispensable == nullptr ? "not supported" : dispensable->shows;
        left_out += fmt::format("{}{} ({})", left_out.empty() ? "" : ", ", shown_uri(name), shows);
    }
    if (!left_out.empty()) document.leave_out("left out: " + left_out);
}

const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions,
                                      const std::string& name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

std::vector<double> numbers_member(const tinygltf::Value& object, const std::string& key) {
    std::vector<double> numbers;
    if (!object.Has(key)) return numbers;
    const tinygltf::Value& array = object.Get(key);
    for (std::size_t i = 0; i < array.ArrayLen(); ++i) {
        numbers.push_back(array.Get(static_cast<int>(i)).GetNumberAsDouble());
    }
    return numbers;
}

}  // namespace kilolux
