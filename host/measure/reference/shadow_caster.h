// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "host/measure/reference/bvh.h"
#include "host/measure/reference/texture_sampler.h"
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
/// Every triangle hides from both sides, but those of materials that blend; alpha masks are sampled
/// at their finest level. A point sees no light on the other side of its own triangle.
class ShadowCaster {
 public:
    /// Builds the hierarchy. Keeps a reference to the scene.
    ShadowCaster(const Scene& scene, const Camera& camera);

    /// The surface's point that the camera sees through p_view [m], a point on it but for rounding;
    /// none if it sees nothing there. `blended`: among the surfaces that blend, else the others.
    std::optional<ShadowPoint> point_at(const glm::dvec3& p_view, bool blended = false) const;

    /// Whether the way from the point to the light at `p_view` [m] is free.
    bool sees(const ShadowPoint& from, const glm::dvec3& p_view) const;
    /// The same for light from a direction, in view space.
    bool sees_direction(const ShadowPoint& from, const glm::dvec3& to_light) const;

 private:
    bool is_free(const ShadowPoint& from, const glm::dvec3& way, double end) const;
    bool hides(const Ray& ray, const RayHit& hit) const;
    bool is_blended_at(const RayHit& hit) const;

    const Scene& scene_;
    Camera camera_;
    Bvh bvh_;
    TextureSampler textures_;
    double length_;  // longer than any way in the scene [m]
};

}  // namespace kilolux
