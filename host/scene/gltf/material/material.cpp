// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/material/material.h"

#include <algorithm>
#include <limits>

#include "host/scene/gltf/material/specular_glossiness.h"
#include "host/scene/gltf/material/texture.h"
#include "host/scene/material_table.h"

namespace kilolux {
namespace {

using nlohmann::json;

constexpr double kMaxFloat = std::numeric_limits<float>::max();

float limited(double value, FactorRange range) {
    if (range == FactorRange::unit) return static_cast<float>(std::clamp(value, 0.0, 1.0));
    // 0 means a Fresnel term of 1 (KHR_materials_ior); other values are at least vacuum's.
    if (range == FactorRange::ior && value != 0.0) value = std::max(value, 1.0);
    const double least = range == FactorRange::finite ? -kMaxFloat : 0.0;
    return static_cast<float>(std::clamp(value, least, kMaxFloat));
}

AlphaMode convert_alpha_mode(const std::string& mode) {
    if (mode == "MASK") return AlphaMode::mask;
    return mode == "BLEND" ? AlphaMode::blend : AlphaMode::opaque;
}

bool is_of_extension(std::string_view path) { return path.starts_with("extensions."); }

// Whether a property counts: specular-glossiness replaces some.
bool counts(const json& source, std::string_view path) {
    return !is_specular_glossiness(source) ||
           !(path.starts_with("pbrMetallicRoughness.") || is_of_extension(path));
}

void read_factors(Material& out, const json& source) {
    for (const MaterialFactor& factor : kMaterialFactors) {
        const json* value =
            counts(source, factor.path) ? find_member(source, factor.path) : nullptr;
        if (value == nullptr) continue;
        const auto numbers = factor_values(out, factor);
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            const json& number = value->is_array() ? value->at(i) : *value;
            numbers[i] = limited(number.get<double>(), factor.range);
        }
    }
    constexpr std::string_view kStrength =
        "extensions.KHR_materials_emissive_strength.emissiveStrength";
    if (const json* strength = find_member(source, kStrength)) {
        for (glm::length_t c = 0; c < 3; ++c) {
            out.emissive[c] =
                limited(out.emissive[c] * strength->get<double>(), FactorRange::positive);
        }
    }
}

Material convert_material(const json& source, FileTextures& textures) {
    Material out;
    if (const json* name = find_member(source, "name"); name != nullptr && name->is_string()) {
        out.name = *name;
    }
    if (is_specular_glossiness(source)) read_specular_glossiness(out, source, textures);
    read_factors(out, source);
    for (const MaterialMap& map : kMaterialMaps) {
        if (counts(source, map.path)) out.*map.member = textures.convert(source, map.path);
    }
    out.alpha_mode = convert_alpha_mode(source.value("alphaMode", ""));
    out.double_sided = source.value("doubleSided", false);
    if (find_member(source, "extensions.KHR_materials_unlit") != nullptr) set_unlit(out);
    return out;
}

bool stretches(const GltfDocument& document, const Material& material, std::size_t index) {
    const auto drives = [&](const AnimatedProperty& property) {
        return property.array == "materials" && property.element == index &&
               property.path.ends_with("anisotropyStrength");
    };
    return !material.unlit &&
           (material.anisotropy_strength > 0.0f || std::ranges::any_of(document.animated, drives));
}

// A material in messages.
std::string named(const Material& material, std::size_t index) {
    return material.name.empty() ? fmt::format("materials[{}]", index)
                                 : fmt::format("material '{}'", shown_uri(material.name));
}

// Renames the TEXCOORD_n that a material uses to 0 and 1 and returns their numbers. Textures of
// further sets are left out.
std::array<int, 2> pack_texcoord_sets(const GltfDocument& document, Material& material,
                                      std::size_t index) {
    std::array<int, 2> sets = {0, 1};
    std::set<int> used;
    for (const MaterialMap& map : kMaterialMaps) {
        const TextureUse& use = material.*map.member;
        if (use.present()) used.insert(use.uv_set);
    }
    if (used.empty() || *used.rbegin() <= 1) return sets;
    sets[0] = *used.begin();
    sets[1] = used.size() > 1 ? *std::next(used.begin()) : *used.begin();
    for (const MaterialMap& map : kMaterialMaps) {
        TextureUse& use = material.*map.member;
        if (!use.present()) continue;
        if (use.uv_set != sets[0] && use.uv_set != sets[1]) {
            document.leave_out(
                fmt::format("{} uses more than two sets of texture coordinates; its textures of "
                            "TEXCOORD_{} are left out",
                            named(material, index), use.uv_set));
            use = {};
        } else {
            use.uv_set = use.uv_set == sets[0] ? 0 : 1;
        }
    }
    return sets;
}

// Base colour and emission are added where no texture or vertex colour multiplies only one.
void make_unlit(const GltfDocument& document, Material& material, bool colored) {
    set_unlit(material);
    const glm::vec3 emissive = material.emissive;
    if (std::max({emissive.x, emissive.y, emissive.z}) == 0.0f) return;
    if (colored || material.base_color_texture.present() || material.emissive_texture.present()) {
        document.leave_out(
            "the emission of points and lines with textures or vertex colours is "
            "left out");
    } else {
        material.base_color += glm::vec4(emissive, 0.0f);
    }
}

// What glass lacks in the picture.
void note_glass(const GltfDocument& document, const Material& material, std::size_t index) {
    constexpr float kSharp = 0.1f;  // roughness of which nobody sees the blur
    if (material.transmission == 0.0f) return;
    const auto left_out = [&](std::string_view what) {
        document.leave_out(fmt::format("{}: {}", named(material, index), what));
    };
    if (material.roughness > kSharp) left_out("rough glass does not blur what is behind it");
    if (material.thickness > 0.0f && material.ior != 1.0f)
        left_out("thick glass does not bend light");
}

// Also where an animation alone stretches its highlights.
bool takes_tangents(const GltfMaterials& materials, std::size_t index) {
    return needs_tangents(materials.materials[index]) || materials.stretched.contains(index);
}

}  // namespace

void set_unlit(Material& material) {
    const Material standard;
    material.unlit = true;
    for (const MaterialMap& map : kMaterialMaps) {
        if (is_of_extension(map.path)) material.*map.member = {};
    }
    for (const MaterialFactor& factor : kMaterialFactors) {
        if (!is_of_extension(factor.path)) continue;
        std::ranges::copy(factor_values(standard, factor), factor_values(material, factor).begin());
    }
}

GltfMaterials convert_materials(const GltfDocument& document) {
    GltfMaterials out;
    FileTextures textures(document);
    out.materials.reserve(document.materials.size());
    for (const json& source : document.materials) {
        out.materials.push_back(convert_material(source, textures));
    }
    out.textures = textures.textures();
    out.images = textures.images();
    add_roughness_textures(document, out);
    for (Material& material : out.materials) {
        const std::size_t index = out.texcoord_sets.size();
        if (stretches(document, material, index)) out.stretched.insert(index);
        out.texcoord_sets.push_back(pack_texcoord_sets(document, material, index));
        note_glass(document, material, index);
    }
    add_line_materials(document, out);
    return out;
}

MeshShading shading_of(const GltfMaterials& materials, const tinygltf::Primitive& primitive) {
    MeshShading shading;
    const auto made = materials.of_lines.find(line_material_of(primitive));
    const bool is_made = corners_of(primitive) < 3 && made != materials.of_lines.end();
    shading.material = is_made ? made->second : primitive.material;
    if (shading.material == kDefaultMaterial) return shading;
    const auto index = static_cast<std::size_t>(shading.material);
    shading.texcoord_sets = materials.texcoord_sets[index];
    shading.needs_tangents = takes_tangents(materials, index);
    shading.tangent_map = tangent_map(materials.materials[index]);
    return shading;
}

LineMaterial line_material_of(const tinygltf::Primitive& primitive) {
    const auto& attributes = primitive.attributes;
    return {primitive.material, attributes.contains("NORMAL"), attributes.contains("TANGENT"),
            attributes.contains("COLOR_0")};
}

void add_line_materials(const GltfDocument& document, GltfMaterials& materials) {
    for (const tinygltf::Mesh& mesh : document.model.meshes) {
        for (const tinygltf::Primitive& primitive : mesh.primitives) {
            if (corners_of(primitive) == 3) continue;
            const LineMaterial key = line_material_of(primitive);
            const auto index = static_cast<std::size_t>(std::max(primitive.material, 0));
            const bool is_default = primitive.material == kDefaultMaterial;
            const bool is_plain = is_default || !takes_tangents(materials, index);
            const bool as_it_is = key.normals && (key.tangents || is_plain);
            if (as_it_is || materials.of_lines.contains(key)) continue;
            Material made = is_default ? Material{} : materials.materials[index];
            for (const MaterialMap& map : kMaterialMaps) {
                if ((TANGENT_USES & (1u << map.use)) != 0) made.*map.member = {};
            }
            made.anisotropy_strength = 0.0f;
            if (!key.normals) make_unlit(document, made, key.colors);
            materials.of_lines[key] = static_cast<int>(materials.materials.size());
            materials.materials.push_back(std::move(made));
            materials.texcoord_sets.push_back(is_default ? std::array<int, 2>{0, 1}
                                                         : materials.texcoord_sets[index]);
        }
    }
}

}  // namespace kilolux
