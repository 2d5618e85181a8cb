// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/shadow_caster.h"

#include <cmath>

#include "host/measure/reference/hit_surface.h"
#include "host/measure/reference/reference_brdf.h"

namespace kilolux {
namespace {

// Least distance of a hit from the point, as a share of the way's length: nearer hits are rounding.
constexpr double kStart = 1e-9;
// How far along the camera's ray a stored point may lie from its surface, relative to its depth.
constexpr double kDepthError = 1e-3;
// Distance of a light from a triangle's plane that float32 cannot tell from 0, relative to the
// light's distances from the point, from the triangle and from the camera.
constexpr double kOnPlane = 1e-6;

}  // namespace

ShadowCaster::ShadowCaster(const Scene& scene, const Camera& camera)
    : scene_(scene),
      camera_(camera),
      bvh_(world_triangles(scene)),
      textures_(scene),
      length_(4.0 * glm::length(bounds(scene).size())) {}

bool ShadowCaster::hides(const Ray& ray, const RayHit& hit) const {
    PixelRay pixel_ray;
    pixel_ray.origin = ray.origin;
    pixel_ray.direction = ray.direction;
    const SurfaceHit surface{scene_, textures_, bvh_.triangles()[hit.index], hit, pixel_ray};
    const Material& material = material_of(surface);
    if (is_blended_at(hit)) return false;
    if (material.alpha_mode != AlphaMode::mask) return true;
    return base_color_at(surface).w >= static_cast<double>(material.alpha_cutoff);
}

bool ShadowCaster::is_blended_at(const RayHit& hit) const {
    const Instance& instance = scene_.instances[bvh_.triangles()[hit.index].instance];
    return is_blended(scene_, scene_.meshes[static_cast<std::size_t>(instance.mesh)]);
}

std::optional<ShadowPoint> ShadowCaster::point_at(const glm::dvec3& p_view, bool blended) const {
    Ray ray;
    const glm::dvec3 way = camera_.world_from_view * p_view;
    ray.direction =
        camera_.orthographic ? camera_.world_from_view * glm::dvec3(0.0, 0.0, p_view.z) : way;
    ray.origin = camera_.position + way - ray.direction;
    ray.t_min = 1.0 - kDepthError;
    ray.t_max = 1.0 + kDepthError;
    std::optional<RayHit> hit;
    if (blended) {  // the nearest to the given point: walls of thin glass are near each other
        bvh_.nearest(ray, [&](const RayHit& found) {
            if (!is_blended_at(found)) return false;
            if (!hit || std::abs(found.t - 1.0) < std::abs(hit->t - 1.0)) hit = found;
            return false;
        });
    } else {
        hit = bvh_.nearest(ray, [&](const RayHit& found) { return hides(ray, found); });
    }
    if (!hit) return std::nullopt;
    const BvhTriangle& triangle = bvh_.triangles()[hit->index];
    ShadowPoint out;
    out.position = ray.origin + hit->t * ray.direction;
    out.normal = glm::normalize(glm::cross(triangle.corners[1] - triangle.corners[0],
                                           triangle.corners[2] - triangle.corners[0]));
    if (glm::dot(out.normal, ray.direction) > 0.0) out.normal = -out.normal;
    out.triangle = hit->index;
    return out;
}

bool ShadowCaster::is_at_end(const ShadowPoint& from, const Way& way, const RayHit& hit) const {
    if (!way.to_position) return false;
    const auto& corners = bvh_.triangles()[hit.index].corners;
    const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const glm::dvec3 light = from.position + way.direction;
    const glm::dvec3 to_light = light - corners[0];
    const double size =
        glm::length(way.direction) + glm::length(to_light) + glm::length(light - camera_.position);
    return std::abs(glm::dot(normal, to_light)) <= kOnPlane * size * glm::length(normal);
}

bool ShadowCaster::is_free(const ShadowPoint& from, const Way& way) const {
    if (!(glm::dot(from.normal, way.direction) > 0.0)) return false;
    const Ray ray{from.position, way.direction, kStart, way.end};
    return !bvh_.nearest(ray, [&](const RayHit& hit) {
        return hit.index != from.triangle && hides(ray, hit) && !is_at_end(from, way, hit);
    });
}

glm::dvec3 ShadowCaster::share_at(const Ray& ray, const RayHit& hit, Shading model) const {
    PixelRay pixel_ray;
    pixel_ray.origin = ray.origin;
    pixel_ray.direction = -ray.direction;  // light's
    const BvhTriangle& triangle = bvh_.triangles()[hit.index];
    const SurfaceHit surface{scene_, textures_, triangle, hit, pixel_ray};
    const glm::dvec3 to_light = glm::normalize(ray.direction);
    if (!material_of(surface).double_sided && !front_facing(surface)) return glm::dvec3(1.0);
    SurfaceSample sample = surface_at(surface);
    sample.normal = glm::normalize(glm::cross(triangle.corners[1] - triangle.corners[0],
                                              triangle.corners[2] - triangle.corners[0]));
    if (glm::dot(sample.normal, to_light) < 0.0) sample.normal = -sample.normal;
    sample.coat_normal = sample.normal;
    return reference_share_behind(sample, to_light, model);
}

glm::dvec3 ShadowCaster::share_on(const ShadowPoint& from, const Way& way, Shading model) const {
    if (!is_free(from, way)) return glm::dvec3(0.0);
    std::vector<RayHit> passed;
    const Ray ray{from.position, way.direction, kStart, way.end};
    bvh_.nearest(ray, [&](const RayHit& hit) {
        const bool is_between = hit.index != from.triangle && !is_at_end(from, way, hit);
        if (is_between && is_blended_at(hit)) passed.push_back(hit);
        return false;
    });
    merge_on_edges(passed, bvh_.triangles());
    glm::dvec3 share(1.0);
    for (const RayHit& hit : passed) share *= share_at(ray, hit, model);
    return share;
}

ShadowCaster::Way ShadowCaster::way_to(const ShadowPoint& from, const glm::dvec3& p_view) const {
    const glm::dvec3 light = camera_.position + camera_.world_from_view * p_view;
    return {light - from.position, 1.0 - kStart, true};
}

ShadowCaster::Way ShadowCaster::way_along(const glm::dvec3& to_light) const {
    return {length_ * (camera_.world_from_view * to_light), 1.0};
}

bool ShadowCaster::sees(const ShadowPoint& from, const glm::dvec3& p_view) const {
    return is_free(from, way_to(from, p_view));
}

bool ShadowCaster::sees_direction(const ShadowPoint& from, const glm::dvec3& to_light) const {
    return is_free(from, way_along(to_light));
}

glm::dvec3 ShadowCaster::share(const ShadowPoint& from, const glm::dvec3& p_view,
                               Shading model) const {
    return share_on(from, way_to(from, p_view), model);
}

glm::dvec3 ShadowCaster::share_of_direction(const ShadowPoint& from, const glm::dvec3& to_light,
                                            Shading model) const {
    return share_on(from, way_along(to_light), model);
}

}  // namespace kilolux
