// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/extensions.h"

#include <algorithm>
#include <array>

namespace kilolux {
namespace {

// An extension that a file may require.
struct KnownExtension {
    std::string_view name;
    std::string_view
        lacks{};  // how the picture shows that it is left out; empty: nothing is missing
};

constexpr std::array kKnown = {
    KnownExtension{"KHR_lights_punctual"},
    KnownExtension{"KHR_texture_transform"},
    KnownExtension{"KHR_mesh_quantization"},
    KnownExtension{"KHR_materials_emissive_strength"},
    KnownExtension{"KHR_materials_unlit"},
    KnownExtension{"KHR_materials_ior"},
    KnownExtension{"KHR_materials_specular"},
    KnownExtension{"KHR_materials_pbrSpecularGlossiness"},
    KnownExtension{"KHR_materials_variants"},
    KnownExtension{"EXT_mesh_gpu_instancing"},
    KnownExtension{"EXT_meshopt_compression"},
    KnownExtension{"KHR_draco_mesh_compression"},
    KnownExtension{"EXT_texture_webp"},
    KnownExtension{"EXT_lights_ies"},
    // Metadata.
    KnownExtension{"KHR_xmp_json_ld"},
    KnownExtension{"KHR_xmp"},
    KnownExtension{"EXT_structural_metadata"},
    KnownExtension{"EXT_feature_metadata"},
    KnownExtension{"EXT_mesh_features"},
    KnownExtension{"EXT_instance_features"},
    // Left out.
    KnownExtension{"KHR_materials_transmission", "glass looks opaque"},
    KnownExtension{"KHR_materials_volume", "thick glass does not tint light"},
    KnownExtension{"KHR_materials_volume_scatter", "no light scatters below surfaces"},
    KnownExtension{"KHR_materials_diffuse_transmission", "leaves and paper let no light through"},
    KnownExtension{"KHR_materials_dispersion", "glass shows no rainbow"},
    KnownExtension{"KHR_materials_clearcoat", "coats have no highlight of their own"},
    KnownExtension{"KHR_materials_sheen", "cloth has no sheen"},
    KnownExtension{"KHR_materials_iridescence", "thin films show no colours"},
    KnownExtension{"KHR_materials_anisotropy", "brushed metal has round highlights"},
    KnownExtension{"KHR_animation_pointer", "what it animates stands still"},
    KnownExtension{"KHR_node_visibility", "hidden nodes are drawn"},
    KnownExtension{"MSFT_lod", "the finest level is drawn"},
};

// A program that makes a file without an extension that is refused.
struct Converter {
    std::string_view name;
    std::string_view command;
};

constexpr std::array kConverters = {
    Converter{"KHR_texture_basisu", "gltf-transform ktxdecompress in.glb out.glb decodes it"},
    Converter{"KHR_meshopt_compression", "gltfpack -i in.glb -o out.glb decodes it"},
};

template <typename Row, std::size_t N>
const Row* find_row(const std::array<Row, N>& rows, const std::string& name) {
    const auto found = std::ranges::find(rows, std::string_view(name), &Row::name);
    return found == rows.end() ? nullptr : &*found;
}

// Extensions that a file uses or requires, each once, in the file's order.
std::vector<std::string> named_extensions(const tinygltf::Model& model) {
    std::vector<std::string> names;
    for (const auto* list : {&model.extensionsRequired, &model.extensionsUsed}) {
        for (const std::string& name : *list) {
            if (std::ranges::count(names, name) == 0) names.push_back(name);
        }
    }
    return names;
}

}  // namespace

void check_extensions(const GltfDocument& document) {
    const tinygltf::Model& model = document.model;
    std::string left_out;
    for (const std::string& name : named_extensions(model)) {
        const KnownExtension* known = find_row(kKnown, name);
        if (known != nullptr && known->lacks.empty()) continue;
        if (known == nullptr && std::ranges::count(model.extensionsRequired, name) > 0) {
            const Converter* converter = find_row(kConverters, name);
            document.fail("extensionsRequired", "the file needs '{}', which is not supported{}",
                          shown_uri(name),
                          converter == nullptr ? "" : fmt::format("; {}", converter->command));
        }
        left_out += fmt::format("{}{} ({})", left_out.empty() ? "" : ", ", shown_uri(name),
                                known == nullptr ? "not supported" : known->lacks);
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
