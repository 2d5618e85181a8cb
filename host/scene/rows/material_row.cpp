// SPDX-License-Identifier: Apache-2.0
#include "host/scene/rows/material_row.h"

#include <algorithm>
#include <cmath>

#include "host/scene/material_table.h"

namespace kilolux {

namespace {

// log2 of the transmittance of 1 m. Of black, which no light passes, that of 1e-30.
glm::vec3 attenuation(const Material& m) {
    return glm::log2(glm::max(m.attenuation_color, 1e-30f)) /
           std::max(m.attenuation_distance, 1e-30f);
}

}  // namespace

MaterialRow material_row(const Material& material) {
    MaterialRow row{};
    const glm::vec3 f0 = dielectric_reflectance(material);
    row.specular = {f0.x, f0.y, f0.z, 0.0f};
    const glm::vec3 left = attenuation(material);
    row.volume = {left.x, left.y, left.z, 0.0f};
    for (const MaterialFactor& factor : kMaterialFactors) {
        if (factor.row == nullptr) continue;
        const auto values = factor_values(material, factor);
        std::ranges::copy(values, &(row.*factor.row).x + factor.component);
    }
    row.anisotropy.y = std::cos(material.anisotropy_rotation);
    row.anisotropy.z = std::sin(material.anisotropy_rotation);
    for (int use = 0; use < USE_COUNT; ++use) {
        const glm::mat3& m = texture_use(material, use).uv_from_texcoord;
        row.uv_x[use] = {m[0].x, m[1].x, m[2].x, 0.0f};
        row.uv_y[use] = {m[0].y, m[1].y, m[2].y, 0.0f};
    }
    return row;
}

const TextureUse& texture_use(const Material& material, int use) {
    return material.*kMaterialMaps[static_cast<std::size_t>(use)].member;
}

bool is_srgb_use(int use) { return kMaterialMaps[static_cast<std::size_t>(use)].srgb; }

}  // namespace kilolux
