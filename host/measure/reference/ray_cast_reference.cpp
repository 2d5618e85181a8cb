// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/ray_cast_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

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

bool is_drawn(const SurfaceHit& hit) { return material_of(hit).double_sided || front_facing(hit); }

SurfaceSample sample_at(const SurfaceHit& hit, const PixelRay& view_ray, const Camera& camera) {
    SurfaceSample out = surface_at(hit);
    out.instance = hit.triangle.instance;
    out.triangle = hit.triangle.triangle;
    out.position = view_ray.origin + hit.hit.t * view_ray.direction;
    const glm::dmat3 view_from_world = glm::transpose(camera.world_from_view);
    for (glm::dvec3* n : {&out.normal, &out.coat_normal}) {
        *n = *n != glm::dvec3(0.0) ? view_from_world * *n : glm::dvec3(0.0, 0.0, 1.0);
    }
    out.tangent = view_from_world * out.tangent;
    return out;
}

}  // namespace

RayCaster::RayCaster(const Scene& scene)
    : scene_(scene), bvh_(world_triangles(scene)), textures_(scene) {}

SurfaceHit RayCaster::hit_of(const RayHit& hit, const PixelRay& ray) const {
    return {scene_, textures_, bvh_.triangles()[hit.index], hit, ray};
}

// The opaque surface, if there is one: a `t` of infinity says that there is none; and those in
// front of it that blend, from far to near.
std::vector<RayHit> RayCaster::surfaces_along(const PixelRay& ray, const Camera& camera) const {
    std::vector<RayHit> out;
    const auto stops = [&](const RayHit& candidate) {
        const SurfaceHit hit = hit_of(candidate, ray);
        if (!is_drawn(hit)) return false;
        if (is_blended(scene_, mesh_of(hit))) {
            out.push_back(candidate);
            return false;
        }
        return coverage_at(hit) > 0.0;
    };
    const auto opaque = bvh_.nearest({.origin = ray.origin,
                                      .direction = ray.direction,
                                      .t_min = camera.z_near,
                                      .t_max = camera.z_far},
                                     stops);
    merge_on_edges(out, bvh_.triangles());
    const RayHit end = opaque.value_or(RayHit{.t = std::numeric_limits<double>::infinity()});
    std::erase_if(out, [&](const RayHit& hit) { return hit.t >= end.t; });
    out.push_back(end);
    const std::vector<BvhTriangle>& triangles = bvh_.triangles();
    std::ranges::sort(out, [&](const RayHit& a, const RayHit& b) {
        return a.t != b.t ? a.t > b.t : drawn_before(triangles[b.index], triangles[a.index]);
    });
    return out;
}

std::vector<SurfaceSamples> RayCaster::cast_layers(const Camera& camera, int width, int height,
                                                   const OnProgress& progress) const {
    std::vector<SurfaceSamples> out(1, make_surface_samples(width, height));
    std::mutex grows;
    const auto cast_pixel = [&](int x, int y) {
        const PixelRay view_ray = pixel_ray(camera, width, height, x, y);
        const PixelRay ray = to_world(view_ray, camera);
        const std::vector<RayHit> hits = surfaces_along(ray, camera);
        for (std::size_t i = 0; i < hits.size(); ++i) {
            if (std::isinf(hits[i].t)) continue;
            const SurfaceSample sample = sample_at(hit_of(hits[i], ray), view_ray, camera);
            const std::scoped_lock lock(grows);
            if (i == out.size()) out.push_back(make_surface_samples(width, height));
            out[i].at(x, y) = sample;
        }
    };
    const auto cast_row = [&](int y) {
        for (int x = 0; x < width; ++x) cast_pixel(x, y);
    };
    parallel_rows(height, cast_row, progress);
    return out;
}

}  // namespace kilolux
