// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/material/texture.h"

#include <cmath>

#include "host/scene/gltf/extensions.h"

namespace kilolux {
namespace {

using nlohmann::json;

Wrap convert_wrap(int code) {
    switch (code) {
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return Wrap::clamp;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return Wrap::mirror;
        default:
            return Wrap::repeat;
    }
}

Sampler convert_sampler(const tinygltf::Sampler& source) {
    Sampler out;
    out.wrap_s = convert_wrap(source.wrapS);
    out.wrap_t = convert_wrap(source.wrapT);
    if (source.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) out.magnify = Filter::nearest;
    const int code = source.minFilter;  // even: nearest within a level; -1: not given
    out.minify = code > 0 && code % 2 == 0 ? Filter::nearest : Filter::linear;
    out.mipmaps = code != TINYGLTF_TEXTURE_FILTER_NEAREST && code != TINYGLTF_TEXTURE_FILTER_LINEAR;
    const bool between_nearest = code == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
                                 code == TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST;
    out.between_mipmaps = between_nearest ? Filter::nearest : Filter::linear;
    return out;
}

// The image a texture shows: the WebP one where the file offers both.
int source_image(const tinygltf::Texture& texture) {
    const tinygltf::Value* webp = find_extension(texture.extensions, "EXT_texture_webp");
    return webp == nullptr ? texture.source : member_or(*webp, "source", texture.source);
}

// KHR_texture_transform: scale, then rotate, then shift. The rotation's sign follows the
// extension's text and first example; the matrix in its GLSL example is the transpose.
glm::mat3 uv_transform(const json& transform) {
    const auto offset = transform.value("offset", std::vector<double>{0.0, 0.0});
    const auto scale = transform.value("scale", std::vector<double>{1.0, 1.0});
    const double angle = transform.value("rotation", 0.0);
    glm::mat3 out(1.0f);
    out[0] = {to_float(scale[0] * std::cos(angle)), to_float(-scale[0] * std::sin(angle)), 0.0f};
    out[1] = {to_float(scale[1] * std::sin(angle)), to_float(scale[1] * std::cos(angle)), 0.0f};
    out[2] = {to_float(offset[0]), to_float(offset[1]), 1.0f};
    return out;
}

}  // namespace

int FileTextures::place(int index) {
    const auto& texture = document_.model.textures[static_cast<std::size_t>(index)];
    const int image = source_image(texture);
    if (image < 0) {
        document_.leave_out(element_name("textures", static_cast<std::size_t>(index)) +
                            " has no image of a supported kind and is left out");
        return -1;
    }
    const auto [entry, is_new] = texture_of_.try_emplace(index, static_cast<int>(textures_.size()));
    if (!is_new) return entry->second;
    const auto [slot, is_new_image] =
        image_of_.try_emplace(image, static_cast<int>(images_.size()));
    if (is_new_image) images_.push_back(image);
    Texture added;
    added.image = slot->second;
    if (texture.sampler >= 0) {
        added.sampler =
            convert_sampler(document_.model.samplers[static_cast<std::size_t>(texture.sampler)]);
    }
    textures_.push_back(added);
    return entry->second;
}

TextureUse FileTextures::convert(const json& material, std::string_view path) {
    TextureUse out;
    const json* info = find_member(material, path);
    if (info == nullptr) return out;
    out.texture = place(info->at("index"));
    if (!out.present()) return out;
    out.uv_set = info->value("texCoord", 0);
    if (const json* transform = find_member(*info, "extensions.KHR_texture_transform")) {
        out.uv_set = transform->value("texCoord", out.uv_set);
        out.uv_from_texcoord = uv_transform(*transform);
    }
    return out;
}

}  // namespace kilolux
