// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/material/material.h"

#include <cmath>

#include "host/scene/gltf/extensions.h"

namespace kilolux {
namespace {

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
glm::mat3 uv_transform(const tinygltf::Value& transform) {
    const std::vector<double> offset = numbers_member(transform, "offset");
    const std::vector<double> scale = numbers_member(transform, "scale");
    const double angle = member_or(transform, "rotation", 0.0);
    const double sx = scale.empty() ? 1.0 : scale[0];
    const double sy = scale.empty() ? 1.0 : scale[1];
    glm::mat3 out(1.0f);
    out[0] = {to_float(sx * std::cos(angle)), to_float(-sx * std::sin(angle)), 0.0f};
    out[1] = {to_float(sy * std::sin(angle)), to_float(sy * std::cos(angle)), 0.0f};
    if (!offset.empty()) out[2] = {to_float(offset[0]), to_float(offset[1]), 1.0f};
    return out;
}

}  // namespace

TextureUse FileTextures::convert(const tinygltf::Value& extension, const std::string& slot) {
    if (!extension.Has(slot)) return {};
    const tinygltf::Value& info = extension.Get(slot);
    tinygltf::ExtensionMap extensions;
    if (info.Has("extensions")) extensions = info.Get("extensions").Get<tinygltf::Value::Object>();
    return convert({member_or(info, "index", -1), member_or(info, "texCoord", 0), &extensions});
}

TextureUse FileTextures::convert(const FileTextureUse& use) {
    TextureUse out;
    if (use.texture < 0) return out;
    const auto& texture = document_.model.textures[static_cast<std::size_t>(use.texture)];
    const int image = source_image(texture);
    if (image < 0) {
        document_.leave_out(element_name("textures", static_cast<std::size_t>(use.texture)) +
                            " has no image of a supported kind and is left out");
        return out;
    }
    const auto [entry, is_new] =
        texture_of_.try_emplace(use.texture, static_cast<int>(textures_.size()));
    if (is_new) {
        const auto [slot, is_new_image] =
            image_of_.try_emplace(image, static_cast<int>(images_.size()));
        if (is_new_image) images_.push_back(image);
        Texture added;
        added.image = slot->second;
        if (texture.sampler >= 0) {
            added.sampler = convert_sampler(
                document_.model.samplers[static_cast<std::size_t>(texture.sampler)]);
        }
        textures_.push_back(added);
    }
    out.texture = entry->second;
    out.uv_set = use.texcoord;
    if (const auto* transform = find_extension(*use.extensions, "KHR_texture_transform")) {
        out.uv_set = member_or(*transform, "texCoord", out.uv_set);
        out.uv_from_texcoord = uv_transform(*transform);
    }
    return out;
}

}  // namespace kilolux
