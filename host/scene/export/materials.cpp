// SPDX-License-Identifier: Apache-2.0
#include "host/scene/export/parts.h"

#include <algorithm>
#include <cmath>

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

class MaterialWriter {
 public:
    explicit MaterialWriter(std::set<std::string>& extensions) : extensions_(extensions) {}

    Json material(const Material& m) {
        Json out = Json::object();
        if (!m.name.empty()) out["name"] = m.name;
        out["pbrMetallicRoughness"] = metallic_roughness(m);
        add_maps(out, m);
        add_emission(out, m);
        if (m.alpha_mode == AlphaMode::mask) {
            out["alphaMode"] = "MASK";
            out["alphaCutoff"] = m.alpha_cutoff;
        } else if (m.alpha_mode == AlphaMode::blend) {
            out["alphaMode"] = "BLEND";
        }
        if (m.double_sided) out["doubleSided"] = true;
        add_reflectance(out, m);
        return out;
    }

 private:
    Json& extension(Json& of, const char* name) {
        extensions_.insert(name);
        Json& out = of["extensions"][name];
        if (out.is_null()) out = Json::object();
        return out;
    }

    void add_texture(Json& to, const char* name, const TextureUse& use) {
        if (!use.present()) return;
        Json out{{"index", use.texture}};
        if (use.uv_set != 0) out["texCoord"] = use.uv_set;
        if (use.uv_from_texcoord != glm::mat3(1.0f)) {
            extension(out, "KHR_texture_transform") = transform_json(use.uv_from_texcoord);
        }
        to[name] = std::move(out);
    }

    Json metallic_roughness(const Material& m) {
        Json out{
            {"baseColorFactor", {m.base_color.x, m.base_color.y, m.base_color.z, m.base_color.w}}};
        add_texture(out, "baseColorTexture", m.base_color_texture);
        out["metallicFactor"] = m.metallic;
        out["roughnessFactor"] = m.roughness;
        add_texture(out, "metallicRoughnessTexture", m.metallic_roughness_texture);
        return out;
    }

    void add_maps(Json& out, const Material& m) {
        add_texture(out, "normalTexture", m.normal_texture);
        if (m.normal_texture.present() && m.normal_scale != 1.0f) {
            out["normalTexture"]["scale"] = m.normal_scale;
        }
        add_texture(out, "occlusionTexture", m.occlusion_texture);
        if (m.occlusion_texture.present() && m.occlusion_strength != 1.0f) {
            out["occlusionTexture"]["strength"] = m.occlusion_strength;
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
        add_texture(out, "emissiveTexture", m.emissive_texture);
        if (strength > 1.0) {
            extension(out, "KHR_materials_emissive_strength")["emissiveStrength"] = strength;
        }
    }

    void add_reflectance(Json& out, const Material& m) {
        const Material standard;
        if (m.unlit) {
            extension(out, "KHR_materials_unlit");
            return;  // nothing of it reflects
        }
        if (m.ior != standard.ior) extension(out, "KHR_materials_ior")["ior"] = m.ior;
        Json specular = Json::object();
        if (m.specular != standard.specular) specular["specularFactor"] = m.specular;
        if (m.specular_color != standard.specular_color) {
            specular["specularColorFactor"] = {m.specular_color.x, m.specular_color.y,
                                               m.specular_color.z};
        }
        add_texture(specular, "specularTexture", m.specular_texture);
        add_texture(specular, "specularColorTexture", m.specular_color_texture);
        if (!specular.empty()) extension(out, "KHR_materials_specular") = std::move(specular);
    }

    std::set<std::string>& extensions_;
};

}  // namespace

ExportedMaterials export_materials(const Scene& scene, std::set<std::string>& extensions) {
    ExportedMaterials out;
    for (const Texture& texture : scene.textures) {
        const int sampler = place_of(out.samplers, sampler_json(texture.sampler));
        out.textures.push_back({{"sampler", sampler}, {"source", texture.image}});
    }
    MaterialWriter writer(extensions);
    for (const Material& material : scene.materials) {
        out.materials.push_back(writer.material(within_factors(material)));
    }
    return out;
}

}  // namespace kilolux
