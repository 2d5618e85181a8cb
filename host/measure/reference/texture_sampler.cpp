// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/texture_sampler.h"

#include <algorithm>
#include <cmath>

#include "host/base/srgb.h"
#include "host/measure/metrics/parallel_rows.h"

namespace kilolux {
namespace {

int floor_mod(int a, int n) {
    const int r = a % n;
    return r < 0 ? r + n : r;
}

// A texel index wrapped into the image (OpenGL 4.5, 8.14.2, table 8.20).
int wrapped(int i, int size, Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat:
            return floor_mod(i, size);
        case Wrap::mirror: {
            const int m = floor_mod(i, 2 * size);
            return m < size ? m : 2 * size - 1 - m;
        }
        case Wrap::clamp:
            break;
    }
    return std::clamp(i, 0, size - 1);
}

// A coordinate in texels as index and fraction; clamped, so that the index fits.
struct TexelCoordinate {
    int index;
    double fraction;
};

TexelCoordinate split(double coordinate) {
    const double clamped = std::clamp(coordinate, -1e9, 1e9);
    const double whole = std::floor(clamped);
    return {static_cast<int>(whole), clamped - whole};
}

std::size_t slot(TextureEncoding encoding) { return encoding == TextureEncoding::srgb ? 1 : 0; }

double footprint_length(const glm::dvec2& uv_step, int width, int height) {
    return std::hypot(uv_step.x * width, uv_step.y * height);
}

TextureFootprint transformed(const TextureUse& use, const TextureFootprint& in) {
    const glm::dmat3 m(use.uv_from_texcoord);
    return {.uv = glm::dvec2(m * glm::dvec3(in.uv, 1.0)),
            .uv_dx = glm::dvec2(m * glm::dvec3(in.uv_dx, 0.0)),
            .uv_dy = glm::dvec2(m * glm::dvec3(in.uv_dy, 0.0))};
}

}  // namespace

TextureSampler::TextureSampler(const Scene& scene) : scene_(scene) {
    for (std::size_t code = 0; code < linear_from_code_.size(); ++code) {
        linear_from_code_[code] = srgb_to_linear(static_cast<double>(code) / 255.0);
    }
    for (auto& by_image : levels_) by_image.resize(scene.images.size());
    for (const Material& material : scene.materials) {
        prepare(material.base_color_texture, TextureEncoding::srgb);
        prepare(material.emissive_texture, TextureEncoding::srgb);
        prepare(material.metallic_roughness_texture, TextureEncoding::linear);
        prepare(material.normal_texture, TextureEncoding::linear);
        prepare(material.occlusion_texture, TextureEncoding::linear);
        prepare(material.specular_texture, TextureEncoding::linear);
        prepare(material.specular_color_texture, TextureEncoding::srgb);
    }
}

void TextureSampler::prepare(const TextureUse& use, TextureEncoding encoding) {
    if (!use.present()) return;
    const int image = scene_.textures[static_cast<std::size_t>(use.texture)].image;
    if (image < 0) return;
    Levels& out = levels_[slot(encoding)][static_cast<std::size_t>(image)];
    if (!out.empty()) return;
    const Image& source = scene_.images[static_cast<std::size_t>(image)];
    out.push_back({.width = source.width, .height = source.height, .texels = {}});
    while (out.back().width > 1 || out.back().height > 1) {
        const Level& above = out.back();
        Level level{.width = std::max(1, above.width / 2),
                    .height = std::max(1, above.height / 2),
                    .texels = {}};
        level.texels.resize(static_cast<std::size_t>(level.width) *
                            static_cast<std::size_t>(level.height));
        parallel_rows(level.height, [&](int y) {
            for (int x = 0; x < level.width; ++x) {
                level.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) +
                             static_cast<std::size_t>(x)] =
                    glm::vec4(averaged(image, encoding, above, x, y));
            }
        });
        out.push_back(std::move(level));
    }
}

glm::dvec4 TextureSampler::averaged(int image, TextureEncoding encoding, const Level& above, int x,
                                    int y) const {
    if (above.width % 2 == 0 && above.height % 2 == 0) {
        return 0.25 * (texel(image, encoding, above, 2 * x, 2 * y) +
                       texel(image, encoding, above, 2 * x + 1, 2 * y) +
                       texel(image, encoding, above, 2 * x, 2 * y + 1) +
                       texel(image, encoding, above, 2 * x + 1, 2 * y + 1));
    }
    Texture clamping;
    clamping.image = image;
    clamping.sampler.wrap_s = clamping.sampler.wrap_t = Wrap::clamp;
    const int width = std::max(1, above.width / 2);
    const int height = std::max(1, above.height / 2);
    return bilinear(clamping, encoding, above, {(x + 0.5) / width, (y + 0.5) / height});
}

const TextureSampler::Levels& TextureSampler::levels(int image, TextureEncoding encoding) const {
    return levels_[slot(encoding)][static_cast<std::size_t>(image)];
}

glm::dvec4 TextureSampler::texel(int image, TextureEncoding encoding, const Level& level, int x,
                                 int y) const {
    const std::size_t index = static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) +
                              static_cast<std::size_t>(x);
    if (!level.texels.empty()) return glm::dvec4(level.texels[index]);
    const std::uint8_t* codes = &scene_.images[static_cast<std::size_t>(image)].rgba[4 * index];
    const double alpha = codes[3] / 255.0;
    if (encoding == TextureEncoding::linear) {
        return {codes[0] / 255.0, codes[1] / 255.0, codes[2] / 255.0, alpha};
    }
    return {linear_from_code_[codes[0]], linear_from_code_[codes[1]], linear_from_code_[codes[2]],
            alpha};
}

glm::dvec4 TextureSampler::bilinear(const Texture& texture, TextureEncoding encoding,
                                    const Level& level, const glm::dvec2& uv) const {
    const TexelCoordinate s = split(uv.x * level.width - 0.5);
    const TexelCoordinate t = split(uv.y * level.height - 0.5);
    const auto at = [&](int i, int j) {
        return texel(texture.image, encoding, level,
                     wrapped(s.index + i, level.width, texture.sampler.wrap_s),
                     wrapped(t.index + j, level.height, texture.sampler.wrap_t));
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), s.fraction),
                    glm::mix(at(0, 1), at(1, 1), s.fraction), t.fraction);
}

glm::dvec4 TextureSampler::nearest(const Texture& texture, TextureEncoding encoding,
                                   const Level& level, const glm::dvec2& uv) const {
    return texel(texture.image, encoding, level,
                 wrapped(split(uv.x * level.width).index, level.width, texture.sampler.wrap_s),
                 wrapped(split(uv.y * level.height).index, level.height, texture.sampler.wrap_t));
}

glm::dvec4 TextureSampler::filtered(Filter filter, const Texture& texture, TextureEncoding encoding,
                                    const Level& level, const glm::dvec2& uv) const {
    return filter == Filter::nearest ? nearest(texture, encoding, level, uv)
                                     : bilinear(texture, encoding, level, uv);
}

glm::dvec4 TextureSampler::sample(const TextureUse& use, TextureEncoding encoding,
                                  const std::array<TextureFootprint, 2>& uv_sets) const {
    if (!use.present()) return glm::dvec4(1.0);
    const Texture& texture = scene_.textures[static_cast<std::size_t>(use.texture)];
    if (texture.image < 0) return glm::dvec4(1.0);
    const Sampler& sampler = texture.sampler;
    const Levels& mips = levels(texture.image, encoding);
    const TextureFootprint at = transformed(use, uv_sets[use.uv_set == 1 ? 1 : 0]);
    const double texels = std::max(footprint_length(at.uv_dx, mips[0].width, mips[0].height),
                                   footprint_length(at.uv_dy, mips[0].width, mips[0].height));
    const double lambda = std::log2(texels);
    if (!(lambda > 0.0)) return filtered(sampler.magnify, texture, encoding, mips[0], at.uv);
    if (!sampler.mipmaps) return filtered(sampler.minify, texture, encoding, mips[0], at.uv);
    const double level = std::min(lambda, static_cast<double>(mips.size() - 1));
    if (sampler.between_mipmaps == Filter::nearest) {
        const auto rounded = static_cast<std::size_t>(std::ceil(level + 0.5) - 1.0);
        return filtered(sampler.minify, texture, encoding, mips[rounded], at.uv);
    }
    const auto lower = static_cast<std::size_t>(level);
    const std::size_t upper = std::min(lower + 1, mips.size() - 1);
    return glm::mix(filtered(sampler.minify, texture, encoding, mips[lower], at.uv),
                    filtered(sampler.minify, texture, encoding, mips[upper], at.uv),
                    level - static_cast<double>(lower));
}

}  // namespace kilolux
