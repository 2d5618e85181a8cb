// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// A triangle in world space, in double, and its place in the scene.
struct BvhTriangle {
    std::array<glm::dvec3, 3> corners;  // [m]
    std::uint32_t instance = 0;
    std::uint32_t triangle = 0;  // of the instance's mesh: indices[3 * triangle ..]
};

struct Ray {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0, 0.0, -1.0};  // any length, the unit of t
    double t_min = 0.0;
    double t_max = 0.0;
};

struct RayHit {
    double t = 0.0;
    std::array<double, 3> weights{};  // barycentric, of the triangle's corners; sum 1
    std::uint32_t index = 0;          // into Bvh::triangles()
};

/// The order in which the rasteriser draws them.
bool drawn_before(const BvhTriangle& a, const BvhTriangle& b);

/// Leaves one of the hits of a ray on the common edge of two triangles of an instance.
void merge_on_edges(std::vector<RayHit>& hits, std::span<const BvhTriangle> triangles);

/// A bounding volume hierarchy over triangles: finds the nearest hit of a ray. Embree builds the
/// hierarchy that the shadow kernels walk, in float32; this one shares no code with it.
class Bvh {
 public:
    /// Leaves out triangles without area or with a coordinate that is not finite. Built top-down by
    /// the surface area heuristic along the longest axis (Wald 2007).
    explicit Bvh(std::vector<BvhTriangle> triangles);

    /// The nearest hit with t_min <= t <= t_max for which `accept` is true, on either side. Of hits
    /// at the same t, the first in drawing order. Watertight: no ray passes between triangles that
    /// share corners (Woop, Benthin and Wald 2013).
    std::optional<RayHit> nearest(const Ray& ray,
                                  const std::function<bool(const RayHit&)>& accept) const;

    const std::vector<BvhTriangle>& triangles() const { return triangles_; }

 private:
    struct Node {
        Box box;
        // Leaf: first triangle. Else: left child; the right child follows it.
        std::uint32_t first = 0;
        std::uint32_t count = 0;  // triangles; 0: not a leaf
    };
    struct Builder;

    std::vector<BvhTriangle> triangles_;
    std::vector<Node> nodes_;
};

/// Every triangle of every instance, in drawing order.
std::vector<BvhTriangle> world_triangles(const Scene& scene);

}  // namespace kilolux
