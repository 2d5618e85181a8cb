// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "host/base/gbuffer_layout.h"
#include "host/certify/lighting_case.h"

namespace kilolux {
namespace {

void put_surface(Synthetic& image, uint x, uint y, const SurfaceSample& s) {
    const std::size_t pixel = std::size_t{y} * image.view.stride + x;
    image.put(PLANE_DEPTH, pixel, depth01_of(image.view, x, y, -s.position.z));
    image.put(PLANE_POSITION_X, pixel, s.position);
    image.put(PLANE_NORMAL_X, pixel, s.normal);
    image.put(PLANE_ALBEDO_R, pixel, s.albedo);
    image.put(PLANE_EMISSIVE_R, pixel, s.emissive);
    image.put(PLANE_ROUGHNESS, pixel, s.roughness);
    image.put(PLANE_METALLIC, pixel, s.metallic);
    image.put(PLANE_OCCLUSION_F, pixel, s.occlusion);
}

// How far a position lies from its pixel's ray at its depth, along an axis.
double off_ray(const View& view, uint x, uint y, const glm::dvec3& p) {
    const glm::dvec3 off = glm::abs(position_at(view, x + 0.5, y + 0.5, -p.z) - p);
    return std::max(off.x, off.y) * (1.0 + 1e-5) + 1e-5 * std::abs(p.z);
}

}  // namespace

LightingCase surface_case(std::span<const SurfaceSample> surfaces, int shading, uint width) {
    const auto count = static_cast<uint>(surfaces.size());
    ViewShape shape{width, std::max((count + width - 1) / width, 1u)};
    shape.rotated = false;
    shape.near = 1e-3;
    const View view = make_view(shape);
    LightingCase input;
    input.features = every_feature(shading);
    input.features.gbuffer = GBUFFER_FULL;
    input.features.directional_lights = false;
    input.features.light_index_bits = 32;
    GBufferNeeds needs;
    needs.layout = GBUFFER_FULL;
    needs.material = needs.occlusion = true;
    input.image = {view, make_gbuffer_layout(needs, view.stride, view.height), {}};
    input.image.bytes.resize(gbuffer_bytes(input.image.layout, view.stride, view.height));
    double pad = 0.0;
    for (uint i = 0; i < count; ++i) {
        put_surface(input.image, i % width, i / width, surfaces[i]);
        pad = std::max(pad, off_ray(view, i % width, i / width, surfaces[i].position));
    }
    input.request.position_pad = static_cast<float>(pad);
    return input;
}

}  // namespace kilolux
