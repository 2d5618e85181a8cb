// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/texture_sampler.h"

#include <algorithm>
#include <cmath>

#include "host/base/formats/srgb.h"
#include "host/measure/metrics/parallel_rows.h"
#include "host/scene/material_table.h"

namespace kilolux {
namespace {

int floor_mod(int a, int n) { return (a % n + n) % n; }

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

TexelCoordinate split_coordinate(double coordinate) {
    const double clamped = std::clamp(coordinate, -1e9, 1e9);
    const double whole = std::floor(clamped);
    return {static_cast<int>(whole), clamped - whole};
}

std::size_t slot(TextureEncoding encoding) { return static_cast<std::size_t>(encoding); }

glm::dvec4 nearest(const MipLevel& level, const Sampler& sampler, const glm::dvec2& uv) {
    return level.texel(
        wrapped(split_coordinate(uv.x * level.width).index, level.width, sampler.wrap_s),
        wrapped(split_coordinate(uv.y * level.height).index, level.height, sampler.wrap_t));
}

glm::dvec4 bilinear(const MipLevel& level, const Sampler& sampler, const glm::dvec2& uv) {
    const TexelCoordinate s = split_coordinate(uv.x * level.width - 0.5);
    const TexelCoordinate t = split_coordinate(uv.y * level.height - 0.5);
    const auto at = [&](int i, int j) {
        return level.texel(wrapped(s.index + i, level.width, sampler.wrap_s),
                           wrapped(t.index + j, level.height, sampler.wrap_t));
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), s.fraction),
                    glm::mix(at(0, 1), at(1, 1), s.fraction), t.fraction);
}

glm::dvec4 filtered(Filter filter, const MipLevel& level, const Sampler& sampler,
                    const glm::dvec2& uv) {
    return filter == Filter::nearest ? nearest(level, sampler, uv) : bilinear(level, sampler, uv);
}

// A texel of the level after `above`.
glm::dvec4 averaged(const MipLevel& above, const MipLevel& level, int x, int y) {
    if (above.width % 2 == 0 && above.height % 2 == 0) {
        return 0.25 * (above.texel(2 * x, 2 * y) + above.texel(2 * x + 1, 2 * y) +
                       above.texel(2 * x, 2 * y + 1) + above.texel(2 * x + 1, 2 * y + 1));
    }
    Sampler clamping;
    clamping.wrap_s = clamping.wrap_t = Wrap::clamp;
    return bilinear(above, clamping, {(x + 0.5) / level.width, (y + 0.5) / level.height});
}

MipLevel next_level(const MipLevel& above) {
    MipLevel level;
    level.width = std::max(1, above.width / 2);
    level.height = std::max(1, above.height / 2);
    const auto width = static_cast<std::size_t>(level.width);
    level.texels.resize(width * static_cast<std::size_t>(level.height));
    parallel_rows(level.height, [&](int y) {
        glm::vec4* const row = &level.texels[width * static_cast<std::size_t>(y)];
        for (int x = 0; x < level.width; ++x) row[x] = glm::vec4(averaged(above, level, x, y));
    });
    return level;
}

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

glm::dvec4 MipLevel::texel(int x, int y) const {
    const std::size_t index =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    if (!image) return glm::dvec4(texels[index]);
    if (!image->rgba16.empty()) {
        const std::uint16_t* v = &image->rgba16[4 * index];
        return glm::dvec4(v[0], v[1], v[2], v[3]) / 65535.0;
    }
    const std::uint8_t* codes = &image->rgba[4 * index];
    const double alpha = codes[3] / 255.0;
    if (encoding == TextureEncoding::linear) {
        return {codes[0] / 255.0, codes[1] / 255.0, codes[2] / 255.0, alpha};
    }
    static const auto linear = srgb_to_linear_table();
    return {linear[codes[0]], linear[codes[1]], linear[codes[2]], alpha};
}

TextureSampler::TextureSampler(const Scene& scene) : scene_(scene) {
    for (auto& by_image : levels_) by_image.resize(scene.images.size());
    for (const Material& material : scene.materials) {
        for (const MaterialMap& map : kMaterialMaps) {
            prepare(material.*map.member,
                    map.srgb ? TextureEncoding::srgb : TextureEncoding::linear);
        }
    }
}

void TextureSampler::prepare(const TextureUse& use, TextureEncoding encoding) {
    if (!use.present()) return;
    const int image = scene_.textures[static_cast<std::size_t>(use.texture)].image;
    if (image < 0) return;
    std::vector<MipLevel>& out = levels_[slot(encoding)][static_cast<std::size_t>(image)];
    if (!out.empty()) return;
    const Image& source = scene_.images[static_cast<std::size_t>(image)];
    out.push_back({source.width, source.height, &source, encoding, {}});
    while (out.back().width > 1 || out.back().height > 1) out.push_back(next_level(out.back()));
}

glm::dvec4 TextureSampler::sample(const TextureUse& use, TextureEncoding encoding,
                                  const std::array<TextureFootprint, 2>& uv_sets) const {
    if (!use.present()) return glm::dvec4(1.0);
    const Texture& texture = scene_.textures[static_cast<std::size_t>(use.texture)];
    if (texture.image < 0) return glm::dvec4(1.0);
    const Sampler& sampler = texture.sampler;
    const auto& mips = levels_[slot(encoding)][static_cast<std::size_t>(texture.image)];
    const TextureFootprint at = transformed(use, uv_sets[use.uv_set == 1 ? 1 : 0]);
    const double texels = std::max(footprint_length(at.uv_dx, mips[0].width, mips[0].height),
                                   footprint_length(at.uv_dy, mips[0].width, mips[0].height));
    const double lambda = std::log2(texels);
    const auto read = [&](Filter filter, std::size_t level) {
        return filtered(filter, mips[level], sampler, at.uv);
    };
    if (!(lambda > 0.0)) return read(sampler.magnify, 0);
    if (!sampler.mipmaps) return read(sampler.minify, 0);
    const double level = std::min(lambda, static_cast<double>(mips.size() - 1));
    if (sampler.between_mipmaps == Filter::nearest) {
        return read(sampler.minify, static_cast<std::size_t>(std::ceil(level + 0.5) - 1.0));
    }
    const auto lower = static_cast<std::size_t>(level);
    const std::size_t upper = std::min(lower + 1, mips.size() - 1);
    return glm::mix(read(sampler.minify, lower), read(sampler.minify, upper),
                    level - static_cast<double>(lower));
}

}  // namespace kilolux
