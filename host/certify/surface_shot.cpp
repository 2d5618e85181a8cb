// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "host/base/gbuffer_layout.h"
#include "host/certify/shot.h"

namespace kilolux {
namespace {

ViewShape shape_of(uint width, uint height, bool orthographic) {
    ViewShape shape{width, height};
    shape.rotated = false;
    shape.near = 1e-3;
    shape.orthographic = orthographic;
    if (orthographic) shape.far = 1e4;
    return shape;
}

void put(Synthetic& image, uint plane, std::size_t pixel, double value) {
    image.plane<float>(plane)[pixel] = static_cast<float>(value);
}

void put3(Synthetic& image, uint first_plane, std::size_t pixel, const glm::dvec3& v) {
    for (int c = 0; c < 3; ++c) put(image, first_plane + static_cast<uint>(c), pixel, v[c]);
}

void put_surface(Synthetic& image, uint x, uint y, const SurfaceSample& s) {
    const std::size_t pixel = std::size_t{y} * image.view.stride + x;
    put(image, PLANE_DEPTH, pixel, depth01_of(image.view, x, y, -s.position.z));
    put3(image, PLANE_POSITION_X, pixel, s.position);
    put3(image, PLANE_NORMAL_X, pixel, s.normal);
    put3(image, PLANE_ALBEDO_R, pixel, s.albedo);
    put3(image, PLANE_EMISSIVE_R, pixel, s.emissive);
    put(image, PLANE_ROUGHNESS, pixel, s.roughness);
    put(image, PLANE_METALLIC, pixel, s.metallic);
    put(image, PLANE_OCCLUSION_F, pixel, s.occlusion);
}

// How far a position lies from its pixel's ray at its depth, along an axis.
double off_ray(const View& view, uint x, uint y, const glm::dvec3& p) {
    const double s = view.orthographic != 0 ? 1.0 : -p.z;
    const double rx = (x + 0.5) * view.ray.x + view.ray.y;
    const double ry = (y + 0.5) * view.ray.z + view.ray.w;
    return std::max(std::abs(rx * s - p.x), std::abs(ry * s - p.y)) * (1.0 + 1e-5) +
           1e-5 * std::abs(p.z);
}

}  // namespace

Shot surface_shot(std::span<const SurfaceSample> surfaces, int shading, uint width,
                  bool orthographic) {
    const auto count = static_cast<uint>(surfaces.size());
    const View view =
        make_view(shape_of(width, std::max((count + width - 1) / width, 1u), orthographic));
    Shot shot;
    shot.features.gbuffer = GBUFFER_FULL;
    shot.features.shading = shading;
    shot.features.material = shot.features.metallic = shot.features.occlusion = true;
    shot.features.spot_lights = true;
    shot.features.light_index_bits = 32;
    GBufferNeeds needs;
    needs.layout = GBUFFER_FULL;
    needs.material = needs.occlusion = true;
    shot.image = {view, make_gbuffer_layout(needs, view.stride, view.height), {}};
    shot.image.bytes.resize(gbuffer_bytes(shot.image.layout, view.stride, view.height));
    double pad = 0.0;
    for (uint i = 0; i < count; ++i) {
        put_surface(shot.image, i % width, i / width, surfaces[i]);
        pad = std::max(pad, off_ray(view, i % width, i / width, surfaces[i].position));
    }
    shot.request.position_pad = static_cast<float>(pad);
    return shot;
}

}  // namespace kilolux
