// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <glm/glm.hpp>

namespace kilolux {

/// Two points are at most `tolerance` apart, in their unit.
inline void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-6) {
    EXPECT_LE(glm::length(a - b), tolerance)
        << "(" << a.x << ", " << a.y << ", " << a.z << ") is not (" << b.x << ", " << b.y << ", "
        << b.z << ")";
}

}  // namespace kilolux
