// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// Casts rays into a scene. Rays pass through surfaces that blend. A triangle's winding decides
/// which side a ray meets, also where a material is double-sided.
class LookAround {
 public:
    /// `box` holds the scene, which outlives this.
    LookAround(const Scene& scene, const Box& box);
    ~LookAround();
    LookAround(const LookAround&) = delete;
    LookAround& operator=(const LookAround&) = delete;

    enum class Side { none, front, back };
    struct Hit {
        float distance = std::numeric_limits<float>::infinity();  // [m]; infinite: no surface
        Side side = Side::none;
        glm::dvec3 normal{0.0};  // unit, of the triangle's front
    };
    /// The first surface along a direction that is farther from the eye than `beyond`, in lengths
    /// of the direction.
    Hit first_hit(const glm::dvec3& eye, const glm::dvec3& direction, float beyond = 0.0f) const;

    /// A level direction, one of 64, and how far from the eye the nearer of the rays just above and
    /// below it meets a surface [m]; infinite where none does.
    struct Level {
        glm::dvec3 direction{0.0};
        double distance = 0.0;
    };
    std::vector<Level> level(const glm::dvec3& eye) const;

    /// How far below the eye the rays beside the plumb line meet a surface [m].
    double below(const glm::dvec3& eye) const;

 private:
    struct Rays;
    std::unique_ptr<Rays> rays_;
};

/// Distance from a point inside the box to its side along a unit direction [m].
double way_out(const Box& box, const glm::dvec3& from, const glm::dvec3& direction);

}  // namespace kilolux
