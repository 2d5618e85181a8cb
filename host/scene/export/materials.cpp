// SPDX-License-Identifier: Apache-2.0
#include "host/scene/export/materials.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/images/images.h"
#include "host/scene/export/parts.h"
#include "host/scene/material_table.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

// glTF 2.0's codes.
constexpr int kNearest = 9728;
constexpr int kLinear = 9729;
constexpr int kMipmapped = 9984;  // + 1: linear within a level, + 2: linear between levels

int wrap_code(Wrap wrap) {
    constexpr int kRepeat = 10497;
    constexpr int kClampToEdge = 33071;
    constexpr int kMirroredRepeat = 33648;
    return wrap == Wrap::clamp ? kClampToEdge : wrap == Wrap::mirror ? kMirroredRepeat : kRepeat;
}

int minify_code(const Sampler& sampler) {
    const bool linear = sampler.minify == Filter::linear;
    if (!sampler.mipmaps) return linear ? kLinear : kNearest;
    return kMipmapped + (linear ? 1 : 0) + (sampler.between_mipmaps == Filter::linear ? 2 : 0);
}

Json sampler_json(const Sampler& sampler) {
    return {{"magFilter", sampler.magnify == Filter::linear ? kLinear : kNearest},
            {"minFilter", minify_code(sampler)},
            {"wrapS", wrap_code(sampler.wrap_s)},
            {"wrapT", wrap_code(sampler.wrap_t)}};
}

// Index of an element in an array without duplicates; appended where it is new.
int place_of(Json& array, const Json& element) {
    const auto found = std::find(array.begin(), array.end(), element);
    if (found != array.end()) return static_cast<int>(found - array.begin());
    array.push_back(element);
    return static_cast<int>(array.size()) - 1;
}

// Offset, rotation and scale of a matrix that KHR_texture_transform made: its columns are
// sx (cos, -sin) and sy (sin, cos).
Json transform_json(const glm::mat3& m) {
    const double x = m[0].x, y = m[0].y;
    const bool turned = y != 0.0 || m[1].x != 0.0f;
    const double angle = turned ? std::atan2(-y, x) : 0.0;
    const double sx = turned ? std::hypot(x, y) : x;
    const double sy = turned ? m[1].x * std::sin(angle) + m[1].y * std::cos(angle) : m[1].y;
    Json out = Json::object();
    if (m[2].x != 0.0f || m[2].y != 0.0f) out["offset"] = {m[2].x, m[2].y};
    if (angle != 0.0) out["rotation"] = angle;
    if (sx != 1.0 || sy != 1.0) out["scale"] = {sx, sy};
    return out;
}

// An unlit colour above 1, which no baseColorFactor holds, as the emission of a black surface.
Material within_factors(Material m) {
    if (!m.unlit || std::max({m.base_color.x, m.base_color.y, m.base_color.z}) <= 1.0f) return m;
    m.unlit = false;
    m.emissive = glm::vec3(m.base_color);
    m.base_color = {0.0f, 0.0f, 0.0f, m.base_color.w};
    m.metallic = m.specular = 0.0f;
    return m;
}

Json use_json(const TextureUse& use) {
    Json out{{"index", use.texture}};
    if (use.uv_set != 0) out["texCoord"] = use.uv_set;
    if (use.uv_from_texcoord != glm::mat3(1.0f)) {
        out["extensions"]["KHR_texture_transform"] = transform_json(use.uv_from_texcoord);
    }
    return out;
}

// Whether a factor of this path is needed: not for a map that the material lacks, nor the cutoff of
// a surface without alpha mask.
bool is_written(const Material& m, std::string_view path) {
    if (path == "emissiveFactor") return false;  // see add_emission()
    if (path == "alphaCutoff") return m.alpha_mode == AlphaMode::mask;
    return std::ranges::all_of(kMaterialMaps, [&](const MaterialMap& map) {
        return (m.*map.member).present() || !path.starts_with(std::string(map.path) + ".");
    });
}

void add_factors(Json& out, const Material& m) {
    const Material standard;
    for (const MaterialFactor& factor : kMaterialFactors) {
        const auto values = factor_values(m, factor);
        if (std::ranges::equal(values, factor_values(standard, factor))) continue;
        if (!is_written(m, factor.path)) continue;
        Json& place = at_path(out, factor.path);
        if (values.size() == 1) {
            place = values[0];
        } else {
            place = std::vector<float>(values.begin(), values.end());
        }
    }
}

// glTF's factor is at most 1. The strength is a power of two, so that the product is exact.
void add_emission(Json& out, const Material& m) {
    const float largest = std::max({m.emissive.x, m.emissive.y, m.emissive.z});
    double strength = 1.0;
    while (largest > strength) strength *= 2.0;
    if (largest > 0.0f) {
        out["emissiveFactor"] = {m.emissive.x / strength, m.emissive.y / strength,
                                 m.emissive.z / strength};
    }
    if (strength > 1.0) {
        out["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
    }
}

Json material_json(const Material& m) {
    Json out = Json::object();
    if (!m.name.empty()) out["name"] = m.name;
    for (const MaterialMap& map : kMaterialMaps) {
        const TextureUse& use = m.*map.member;
        if (use.present()) at_path(out, map.path) = use_json(use);
    }
    add_factors(out, m);
    add_emission(out, m);
    if (m.alpha_mode == AlphaMode::mask) out["alphaMode"] = "MASK";
    if (m.alpha_mode == AlphaMode::blend) out["alphaMode"] = "BLEND";
    if (m.double_sided) out["doubleSided"] = true;
    if (m.unlit) out["extensions"]["KHR_materials_unlit"] = Json::object();
    return out;
}

template <typename T>
bool is_opaque(const std::vector<T>& rgba) {
    for (std::size_t i = 3; i < rgba.size(); i += 4) {
        if (rgba[i] != std::numeric_limits<T>::max()) return false;
    }
    return true;
}

}  // namespace

Json& at_path(Json& object, std::string_view path) {
    const std::size_t end = std::min(path.find('.'), path.size());
    Json& member = object[std::string(path.substr(0, end))];
    return end == path.size() ? member : at_path(member, path.substr(end + 1));
}

ExportedMaterials export_materials(const Scene& scene) {
    ExportedMaterials out;
    for (const Texture& texture : scene.textures) {
        const int sampler = place_of(out.samplers, sampler_json(texture.sampler));
        out.textures.push_back({{"sampler", sampler}, {"source", texture.image}});
    }
    for (const Material& material : scene.materials) {
        out.materials.push_back(material_json(within_factors(material)));
    }
    return out;
}

std::vector<unsigned char> encode_png(const Image& image) {
    const SampleType type = image.rgba16.empty() ? SampleType::uint8 : SampleType::uint16;
    ImageLayout layout{image.width, image.height, {}};
    for (const char* name : {"R", "G", "B"}) layout.channels.push_back({name, type});
    if (!is_opaque(image.rgba) || !is_opaque(image.rgba16)) layout.channels.push_back({"A", type});
    layout.attributes.emplace_back("png:compressionLevel", 6);
    const auto* pixels = image.rgba16.empty()
                             ? image.rgba.data()
                             : reinterpret_cast<const unsigned char*>(image.rgba16.data());
    return encode_pixels("image '" + image.name + "'", "png", layout, {pixels, image.bytes()},
                         4 * size_of(type));
}

}  // namespace kilolux
