// SPDX-License-Identifier: Apache-2.0
#include "host/scene/rows/texture_table.h"

#include <fmt/format.h>

#include "host/base/error.h"
#include "host/base/formats/mips.h"
#include "host/scene/rows/vertex_rows.h"

namespace kilolux {
namespace {

uint wrap_of(Wrap wrap) {
    switch (wrap) {
        case Wrap::clamp:
            return WRAP_CLAMP;
        case Wrap::mirror:
            return WRAP_MIRROR;
        default:
            return WRAP_REPEAT;
    }
}

uint filters_of(const Sampler& sampler) {
    uint bits = 0;
    if (sampler.magnify == Filter::nearest) bits |= FILTER_MAGNIFY_NEAREST;
    if (sampler.minify == Filter::nearest) bits |= FILTER_MINIFY_NEAREST;
    if (!sampler.mipmaps) bits |= FILTER_NO_MIPMAPS;
    if (sampler.between_mipmaps == Filter::nearest) bits |= FILTER_NEAREST_MIPMAP;
    return bits;
}

void check_size(const Image& image) {
    constexpr int kLargest = 1 << (TEXTURE_LEVELS - 1);
    if (image.width <= kLargest && image.height <= kLargest) return;
    throw Error(fmt::format("image '{}': {}x{} pixels; textures have at most {} a side", image.name,
                            image.width, image.height, kLargest));
}

}  // namespace

TextureTable::TextureTable(const Scene& scene, const MeshFeatures& features) : scene_(scene) {
    for (const Mesh& mesh : scene.meshes) {
        const auto read = features(mesh);
        for (int use = 0; read && use < USE_COUNT; ++use) {
            const TextureUse& texture = texture_use(material_of(scene, mesh), use);
            if (!reads_use(scene, mesh, use) || (read->texture_uses & (1u << use)) == 0) continue;
            add(texture.texture, is_srgb_use(use));
        }
    }
    checked_count(texels_, scene);
}

void TextureTable::add(int texture, bool srgb) {
    if (numbers_.contains({texture, srgb})) return;
    const Texture& source = scene_.textures[static_cast<std::size_t>(texture)];
    if (source.image < 0) return;
    const Image& image = scene_.images[static_cast<std::size_t>(source.image)];
    check_size(image);
    TextureRow row{};
    row.filters = filters_of(source.sampler);
    row.wrap_s = wrap_of(source.sampler.wrap_s);
    row.wrap_t = wrap_of(source.sampler.wrap_t);
    place_mips(row, static_cast<uint>(image.width), static_cast<uint>(image.height),
               place_image(source.image, srgb));
    numbers_[{texture, srgb}] = static_cast<uint>(rows_.size());
    rows_.push_back(row);
}

std::size_t TextureTable::place_image(int image, bool srgb) {
    const auto [place, is_new] = first_texel_.try_emplace({image, srgb}, texels_);
    if (is_new) {
        const Image& source = scene_.images[static_cast<std::size_t>(image)];
        texels_ += mip_texels(static_cast<uint>(source.width), static_cast<uint>(source.height));
    }
    return place->second;
}

uint TextureTable::number_of(const Material& material, int use) const {
    const TextureUse& texture = texture_use(material, use);
    if (!texture.present()) return SURFACE_ABSENT;
    const auto found = numbers_.find({texture.texture, is_srgb_use(use)});
    return found == numbers_.end() ? SURFACE_ABSENT : found->second;
}

}  // namespace kilolux
