// SPDX-License-Identifier: Apache-2.0
#include "host/render/plan/grid_request.h"

#include <algorithm>

namespace kilolux {

GridRequest grid_request(const GridSettings& settings, const Camera& camera, const Box& box,
                         float pad) {
    GridRequest request;
    request.tiles_x = static_cast<uint>(settings.tiles_x);
    request.tiles_y = static_cast<uint>(settings.tiles_y);
    request.slices_per_octave = static_cast<uint>(settings.slices_per_octave);
    request.fine_per_octave = static_cast<uint>(settings.fine_per_octave);
    request.position_pad = pad;
    double farthest = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                           corner & 4 ? box.max.z : box.min.z);
        if (!box.empty())
            farthest =
                std::max(farthest, -glm::dot(camera.world_from_view[2], p - camera.position));
    }
    farthest = std::min(std::max(farthest, 1e-6), camera.z_far);
    // A parallel view has no smallest distance: slices as fine as a 256th of the depth.
    const double nearest = camera.orthographic ? farthest / 256.0 : camera.z_near;
    request.z_first = static_cast<float>(std::min(nearest, farthest));
    request.z_last = static_cast<float>(farthest);
    return request;
}

float position_pad(uint layout, const Box& box, const Camera& camera) {
    if (box.empty()) return 0.0f;
    const glm::dvec3 world = glm::max(glm::abs(box.min), glm::abs(box.max));
    const double largest = std::max({world.x, world.y, world.z});
    const double reach = glm::length(box.size()) + glm::length(camera.position - box.center());
    // Half: 11 bits round a coordinate by up to 2^-11 of itself, a position by sqrt(3) of that.
    // Float32: vertices, their interpolation and turning to the world and back are some ulp (6e-8)
    // of `reach`.
    if (layout == GBUFFER_HALF) return static_cast<float>(1.8 * largest * 0x1p-11 + 4e-6 * reach);
    const bool stored = layout == GBUFFER_FULL || layout == GBUFFER_OCT_2X4;
    return stored ? static_cast<float>(4e-6 * reach) : 0.0f;
}

}  // namespace kilolux
