// SPDX-License-Identifier: Apache-2.0
#include "host/picture/decoded_surfaces.h"

namespace kilolux {
double luminance_of(const glm::dvec3& color) {
    return glm::dot(color, glm::dvec3(0.2126, 0.7152, 0.0722));
}

double illuminance_at(const DecodedSurfaces& s, std::size_t i) {
    const std::size_t plane = std::size_t{s.view.stride} * s.view.height;
    return luminance_of({s.illuminance[i], s.illuminance[plane + i], s.illuminance[2 * plane + i]});
}

double hidden_share(const DecodedSurfaces& s, std::size_t i) {
    if (s.facing[i] == 0) return 0.0;
    return 1.0 - static_cast<double>(s.seen[i]) / static_cast<double>(s.facing[i]);
}

std::optional<uint> coarse_cluster_at(const DecodedSurfaces& s, std::size_t pixel) {
    const float z = s.at(SURFACE_DEPTH, pixel);
    if (z == 0.0f) return std::nullopt;
    const uint x = static_cast<uint>(pixel % s.view.stride) / s.grid.tile_width;
    const uint row = static_cast<uint>(pixel / s.view.stride) + s.view.first_row;
    return cluster_index(s.grid, x, row / s.grid.tile_height, slice_of_depth(s.grid, z));
}

double mean_over_surfaces(const std::vector<uint>& counts) {
    double sum = 0.0;
    std::size_t surfaces = 0;
    for (const uint count : counts) {
        if (count == kBackground) continue;
        sum += count;
        ++surfaces;
    }
    return surfaces > 0 ? sum / static_cast<double>(surfaces) : 0.0;
}

}  // namespace kilolux
