// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/ray_cast_reference.h"

#include "host/measure/reference/camera_rays.h"
#include "host/measure/reference/hit_surface.h"

namespace kilolux {
namespace {

PixelRay to_world(const PixelRay& view, const Camera& camera) {
    const glm::dmat3& m = camera.world_from_view;
    return {.origin = camera.position + m * view.origin,
            .direction = m * view.direction,
            .origin_dx = m * view.origin_dx,
            .origin_dy = m * view.origin_dy,
            .direction_dx = m * view.direction_dx,
            .direction_dy = m * view.direction_dy};
}

// Whether the ray ends there: the side is drawn, and the surface is opaque there.
bool stops(const SurfaceHit& hit) {
    const Material& material = material_of(hit);
    if (!material.double_sided && !front_facing(hit)) return false;
    switch (material.alpha_mode) {
        case AlphaMode::mask:
            return base_color_at(hit).w >= material.alpha_cutoff;
        case AlphaMode::blend:
            return false;
        case AlphaMode::opaque:
            break;
    }
    return true;
}

}  // namespace

RayCaster::RayCaster(const Scene& scene)
    : scene_(scene), bvh_(world_triangles(scene)), textures_(scene) {}

SurfaceSamples RayCaster::cast(const Camera& camera, int width, int height,
                               const OnProgress& progress) const {
    SurfaceSamples out = make_surface_samples(width, height);
    const glm::dmat3 view_from_world = glm::transpose(camera.world_from_view);
    const auto cast_pixel = [&](int x, int y) {
        const PixelRay view_ray = pixel_ray(camera, width, height, x, y);
        const PixelRay ray = to_world(view_ray, camera);
        const auto hit_of = [&](const RayHit& hit) {
            return SurfaceHit{scene_, textures_, bvh_.triangles()[hit.index], hit, ray};
        };
        const auto hit =
            bvh_.nearest({.origin = ray.origin,
                          .direction = ray.direction,
                          .t_min = camera.z_near,
                          .t_max = camera.z_far},
                         [&](const RayHit& candidate) { return stops(hit_of(candidate)); });
        if (!hit) return;
        SurfaceSample& sample = out.at(x, y);
        sample = surface_at(hit_of(*hit));
        sample.instance = bvh_.triangles()[hit->index].instance;
        sample.triangle = bvh_.triangles()[hit->index].triangle;
        sample.position = view_ray.origin + hit->t * view_ray.direction;
        for (glm::dvec3* n : {&sample.normal, &sample.coat_normal}) {
            *n = *n != glm::dvec3(0.0) ? view_from_world * *n : glm::dvec3(0.0, 0.0, 1.0);
        }
        sample.tangent = view_from_world * sample.tangent;
    };
    const auto cast_row = [&](int y) {
        for (int x = 0; x < width; ++x) cast_pixel(x, y);
    };
    parallel_rows(height, cast_row, progress);
    return out;
}

}  // namespace kilolux
