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

/// How a scene encloses what is within it.
struct Enclosure {
    SceneKind kind = SceneKind::open;
    double within = 0.0;  // share of the rays from a point within that meet fronts
    double open = 0.0;    // share of the view of its front faces that is outside
};

/// `interior`: at least half of the rays from a point within meet front faces, and less than a
/// third of the view of its front faces is outside: from there it would show back faces, nothing,
/// or little of itself. `closed`: at least half of the rays from its middle meet back faces. Else
/// `open`.
Enclosure enclosure_of(const Scene& scene, const Box& box);

}  // namespace kilolux
