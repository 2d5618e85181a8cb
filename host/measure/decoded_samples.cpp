// SPDX-License-Identifier: Apache-2.0
#include "host/measure/decoded_samples.h"

namespace kilolux {
namespace {

double value_at(const DecodedSurfaces& s, std::size_t plane, std::size_t pixel) {
    return s.planes[plane * s.view.stride * s.view.height + pixel];
}

glm::dvec3 vector_at(const DecodedSurfaces& s, std::size_t plane, std::size_t pixel) {
    return {value_at(s, plane, pixel), value_at(s, plane + 1, pixel),
            value_at(s, plane + 2, pixel)};
}

SurfaceSample sample_at(const DecodedSurfaces& s, std::size_t pixel) {
    SurfaceSample out;
    if (value_at(s, SURFACE_DEPTH, pixel) == 0.0) return out;
    out.kind = SurfaceKind::lit;
    out.position = vector_at(s, SURFACE_POSITION, pixel);
    out.normal = vector_at(s, SURFACE_NORMAL, pixel);
    out.albedo = vector_at(s, SURFACE_ALBEDO, pixel);
    out.emissive = vector_at(s, SURFACE_EMISSIVE, pixel);
    out.roughness = value_at(s, SURFACE_ROUGHNESS, pixel);
    out.metallic = value_at(s, SURFACE_METALLIC, pixel);
    out.occlusion = value_at(s, SURFACE_OCCLUSION, pixel);
    return out;
}

}  // namespace

SurfaceSamples surface_samples(const DecodedSurfaces& decoded) {
    const View& view = decoded.view;
    SurfaceSamples out =
        make_surface_samples(static_cast<int>(view.width), static_cast<int>(view.height));
    for (std::size_t y = 0; y < view.height; ++y) {
        for (std::size_t x = 0; x < view.width; ++x) {
            out.pixels[y * view.width + x] = sample_at(decoded, y * view.stride + x);
        }
    }
    return out;
}

}  // namespace kilolux
