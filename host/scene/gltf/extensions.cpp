// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/extensions.h"

#include <algorithm>
#include <array>

#include "host/scene/lights/light_kinds.h"
#include "host/scene/material_table.h"

namespace kilolux {
namespace {

// Beside those of the tables of materials and lights.
constexpr auto kRead = std::to_array<std::string_view>(
    {"KHR_texture_transform", "KHR_mesh_quantization", "KHR_materials_emissive_strength",
     "KHR_materials_unlit", "KHR_materials_pbrSpecularGlossiness", "KHR_materials_variants",
     "EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "KHR_draco_mesh_compression",
     "EXT_texture_webp", "EXT_lights_ies", "KHR_meshopt_compression", "KHR_accessor_float64",
     "KHR_node_visibility", "KHR_animation_pointer"});

// What no still picture shows: metadata, sound, physics, what a user may point at.
constexpr auto kUnseen =
    std::to_array<std::string_view>({"KHR_xmp_json_ld",         "KHR_xmp",
                                     "EXT_structural_metadata", "EXT_feature_metadata",
                                     "EXT_mesh_features",       "EXT_instance_features",
                                     "EXT_mesh_manifold",       "KHR_node_hoverability",
                                     "KHR_node_selectability",  "KHR_audio",
                                     "KHR_audio_emitter",       "KHR_physics_rigid_bodies",
                                     "KHR_implicit_shapes",     "AGI_stk_metadata",
                                     "GODOT_single_root",       "MPEG_media",
                                     "MPEG_audio_spatial",      "OMI_collider",
                                     "OMI_physics_body",        "OMI_physics_shape"});

constexpr std::array kLeftOut = {
    LeftOutExtension{"MSFT_lod", "the finest level is drawn"},
};

// A program that makes a file without an extension that is refused.
struct Converter {
    std::string_view name;
    std::string_view command;
};

constexpr std::array kConverters = {
    Converter{"KHR_texture_basisu", "gltf-transform ktxdecompress in.glb out.glb decodes it"},
};

template <typename Row, std::size_t N>
const Row* find_row(const std::array<Row, N>& rows, const std::string& name) {
    const auto found = std::ranges::find(rows, std::string_view(name), &Row::name);
    return found == rows.end() ? nullptr : &*found;
}

// Whether a map or a factor of materials is of an extension.
template <std::size_t N, typename Row>
bool names_extension(const std::array<Row, N>& rows, const std::string& name) {
    const std::string path = "extensions." + name + ".";
    return std::ranges::any_of(rows, [&](const Row& row) { return row.path.starts_with(path); });
}

bool is_read(const std::string& name) {
    return std::ranges::count(kRead, std::string_view(name)) > 0 ||
           std::ranges::count(kUnseen, std::string_view(name)) > 0 ||
           std::ranges::count(kLightExtensions, std::string_view(name)) > 0 ||
           names_extension(kMaterialMaps, name) || names_extension(kMaterialFactors, name);
}

// Null for one that is not left out, or not known.
const LeftOutExtension* find_left_out(const std::string& name) {
    const auto* of_materials = find_row(kLeftOutMaterialExtensions, name);
    return of_materials != nullptr ? of_materials : find_row(kLeftOut, name);
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
        if (is_read(name)) continue;
        const LeftOutExtension* known = find_left_out(name);
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
