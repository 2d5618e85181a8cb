// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/shadow_caster.h"

#include "host/measure/reference/hit_surface.h"

namespace kilolux {
namespace {

// Least distance of a hit from the point, as a share of the way's length: nearer hits are rounding.
constexpr double kStart = 1e-9;
// How far along the camera's ray a stored point may lie from its surface, relative to its depth.
constexpr double kDepthError = 1e-3;

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
    if (is_blended(material)) return false;
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
    const auto hit = bvh_.nearest(ray, [&](const RayHit& found) {
        return blended ? is_blended_at(found) : hides(ray, found);
    });
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

bool ShadowCaster::is_free(const ShadowPoint& from, const glm::dvec3& way, double end) const {
    if (!(glm::dot(from.normal, way) > 0.0)) return false;
    const Ray ray{from.position, way, kStart, end};
    return !bvh_.nearest(
        ray, [&](const RayHit& hit) { return hit.index != from.triangle && hides(ray, hit); });
}

bool ShadowCaster::sees(const ShadowPoint& from, const glm::dvec3& p_view) const {
    const glm::dvec3 light = camera_.position + camera_.world_from_view * p_view;
    return is_free(from, light - from.position, 1.0 - kStart);
}

bool ShadowCaster::sees_direction(const ShadowPoint& from, const glm::dvec3& to_light) const {
    return is_free(from, length_ * (camera_.world_from_view * to_light), 1.0);
}

}  // namespace kilolux
