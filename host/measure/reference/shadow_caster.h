// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "host/measure/reference/bvh.h"
#include "host/measure/reference/texture_sampler.h"
#include "host/render/settings.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

/// A point of a surface that a camera sees, in the world.
struct ShadowPoint {
    glm::dvec3 position{0.0};    // [m]
    glm::dvec3 normal{0.0};      // of its triangle, on the side that the camera sees
    std::uint32_t triangle = 0;  // index into Bvh::triangles()
};

/// Finds which lights points see, by rays in double, as the reference of the kernels' shadows.
/// Every triangle hides from both sides; alpha masks are sampled at their finest level. Triangles
/// that blend or transmit hide nothing, but let a share pass: see share(). A point sees no light on
/// the other side of its own triangle. A triangle in whose plane a light lies, but for rounding to
/// float32, does not hide it: emissive surfaces are lights.
class ShadowCaster {
 public:
    /// Builds the hierarchy. Keeps a reference to the scene.
    ShadowCaster(const Scene& scene, const Camera& camera);

    /// The surface's point that the camera sees through p_view [m], a point on it but for rounding;
    /// none if it sees nothing there. `blended`: among the surfaces that blend, else the others.
    std::optional<ShadowPoint> point_at(const glm::dvec3& p_view, bool blended = false) const;

    /// Whether nothing hides the light at `p_view` [m] from the point.
    bool sees(const ShadowPoint& from, const glm::dvec3& p_view) const;
    /// The same for light from a direction, in view space.
    bool sees_direction(const ShadowPoint& from, const glm::dvec3& to_light) const;

    /// The share of a light that comes to the point: 0 if it is hidden, else by `model` the product
    /// over the surfaces between that blend or transmit, with their triangle's normal; those of one
    /// side count where the light meets it.
    glm::dvec3 share(const ShadowPoint& from, const glm::dvec3& p_view, Shading model) const;
    glm::dvec3 share_of_direction(const ShadowPoint& from, const glm::dvec3& to_light,
                                  Shading model) const;

 private:
    // The way in the world from a point to a light, as long as `end` times `direction`.
    struct Way {
        glm::dvec3 direction;
        double end;
        bool to_position = false;  // of a light, else to one without
    };
    Way way_to(const ShadowPoint& from, const glm::dvec3& p_view) const;
    Way way_along(const glm::dvec3& to_light) const;
    bool is_free(const ShadowPoint& from, const Way& way) const;
    glm::dvec3 share_on(const ShadowPoint& from, const Way& way, Shading model) const;
    glm::dvec3 share_at(const Ray& ray, const RayHit& hit, Shading model) const;
    bool hides(const Ray& ray, const RayHit& hit) const;
    bool is_blended_at(const RayHit& hit) const;
    bool is_at_end(const ShadowPoint& from, const Way& way, const RayHit& hit) const;

    const Scene& scene_;
    Camera camera_;
    Bvh bvh_;
    TextureSampler textures_;
    double length_;  // longer than any way in the scene [m]
};

}  // namespace kilolux
