// SPDX-License-Identifier: Apache-2.0
#include "raster/gpu_textures.h"

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <string>

#include "host/base/error.h"
#include "raster/material_features.h"

namespace kilolux {
namespace {

GLint gl_wrap(Wrap wrap) {
    switch (wrap) {
        case Wrap::clamp:
            return GL_CLAMP_TO_EDGE;
        case Wrap::mirror:
            return GL_MIRRORED_REPEAT;
        default:
            return GL_REPEAT;
    }
}

GLint gl_minify(const Sampler& sampler) {
    const bool linear = sampler.minify == Filter::linear;
    if (!sampler.mipmaps) return linear ? GL_LINEAR : GL_NEAREST;
    if (sampler.between_mipmaps == Filter::linear) {
        return linear ? GL_LINEAR_MIPMAP_LINEAR : GL_NEAREST_MIPMAP_LINEAR;
    }
    return linear ? GL_LINEAR_MIPMAP_NEAREST : GL_NEAREST_MIPMAP_NEAREST;
}

// Anisotropic filtering became core in 4.6; before that every driver of note has the extension.
float largest_anisotropy() {
    if (!epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic") &&
        !epoxy_has_gl_extension("GL_ARB_texture_filter_anisotropic")) {
        return 1.0f;
    }
    float largest = 1.0f;
    glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY, &largest);
    return largest;
}

GlSampler upload_sampler(const Sampler& sampler, float anisotropy) {
    GlSampler out = make_sampler();
    glSamplerParameteri(out.name(), GL_TEXTURE_WRAP_S, gl_wrap(sampler.wrap_s));
    glSamplerParameteri(out.name(), GL_TEXTURE_WRAP_T, gl_wrap(sampler.wrap_t));
    glSamplerParameteri(out.name(), GL_TEXTURE_MAG_FILTER,
                        sampler.magnify == Filter::linear ? GL_LINEAR : GL_NEAREST);
    glSamplerParameteri(out.name(), GL_TEXTURE_MIN_FILTER, gl_minify(sampler));
    if (anisotropy > 1.0f && sampler.mipmaps && sampler.minify == Filter::linear) {
        glSamplerParameterf(out.name(), GL_TEXTURE_MAX_ANISOTROPY, anisotropy);
    }
    return out;
}

GlTexture upload_image(const Image& image, bool srgb) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    if (image.width > largest || image.height > largest) {
        throw Error(fmt::format("image '{}': {}x{} pixels, this OpenGL takes at most {} a side",
                                image.name, image.width, image.height, largest));
    }
    const auto longest = static_cast<unsigned>(std::max(image.width, image.height));
    GlTexture texture = make_texture(GL_TEXTURE_2D);
    glTextureStorage2D(texture.name(), static_cast<GLsizei>(std::bit_width(longest)),
                       srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, image.width, image.height);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(texture.name(), 0, 0, 0, image.width, image.height, GL_RGBA,
                        GL_UNSIGNED_BYTE, image.rgba.data());
    glGenerateTextureMipmap(texture.name());
    return texture;
}

}  // namespace

GpuTextures::GpuTextures(const Scene& scene, float anisotropy) {
    const float limited = std::min(anisotropy, largest_anisotropy());
    for (const Texture& texture : scene.textures) {
        samplers_.push_back(upload_sampler(texture.sampler, limited));
    }
}

void GpuTextures::upload(const Scene& scene, const Material& material, uint features) {
    for (int slot = 0; slot < USE_COUNT; ++slot) {
        if ((features & (kFeatureTexture << slot)) == 0) continue;
        const TextureUse& use = texture_use(material, slot);
        const int image = scene.textures[static_cast<std::size_t>(use.texture)].image;
        GlTexture& texture = textures_[{image, is_srgb_use(slot)}];
        if (texture) continue;
        texture = upload_image(scene.images[static_cast<std::size_t>(image)], is_srgb_use(slot));
    }
}

void GpuTextures::bind(const Scene& scene, const TextureUse& use, int slot) const {
    const auto index = static_cast<std::size_t>(use.texture);
    const auto unit = static_cast<GLuint>(slot);
    const auto found = textures_.find({scene.textures[index].image, is_srgb_use(slot)});
    glBindTextureUnit(unit, found->second.name());
    glBindSampler(unit, samplers_[index].name());
}

}  // namespace kilolux
