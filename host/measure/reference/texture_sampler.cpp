// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/texture_sampler.h"

#include <algorithm>
#include <cmath>

#include "host/measure/metrics/parallel_rows.h"
#include "host/scene/material_table.h"

namespace kilolux {
namespace {

std::size_t slot(TextureEncoding encoding) { return static_cast<std::size_t>(encoding); }

// A texel of the level after `above`.
glm::dvec4 averaged(const MipLevel& above, const MipLevel& level, int x, int y) {
    if (above.width % 2 == 0 && above.height % 2 == 0) {
        return 0.25 * (above.texel(2 * x, 2 * y) + above.texel(2 * x + 1, 2 * y) +
                       above.texel(2 * x, 2 * y + 1) + above.texel(2 * x + 1, 2 * y + 1));
    }
    Sampler clamping;
    clamping.wrap_s = clamping.wrap_t = Wrap::clamp;
    return filtered(Filter::linear, above, clamping,
                    {(x + 0.5) / level.width, (y + 0.5) / level.height});
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
