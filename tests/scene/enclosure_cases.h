// SPDX-License-Identifier: Apache-2.0
// Shapes, and whether they are interiors.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "host/scene/enclosure.h"
#include "host/scene/generated/mesh_builder.h"

namespace kilolux {

using Build = std::function<void(MeshBuilder&)>;

inline Scene scene_of(Mesh mesh) {
    Scene scene;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({0, glm::dmat4(1.0)});
    return scene;
}

inline Scene built(const Build& build) {
    MeshBuilder builder;
    build(builder);
    return scene_of(builder.build("shape", -1, 1.0, false));
}

// Boxes given by their middle and size.
inline void block(MeshBuilder& b, const glm::dvec3& middle, const glm::dvec3& size) {
    b.box(middle - 0.5 * size, middle + 0.5 * size);
}

// A floor or a lid, walls, and thickness: an open crate where there is no lid.
inline void crate(MeshBuilder& b, const glm::dvec3& at, const glm::dvec3& size, double wall,
                  unsigned open) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-0.5, 0.5}) {
            if ((open >> (2 * axis + (side > 0.0)) & 1u) != 0) continue;
            glm::dvec3 middle = at, plate = size;
            middle[axis] += side * (size[axis] - wall);
            plate[axis] = wall;
            block(b, middle, plate);
        }
    }
}

inline void ball(MeshBuilder& b, const glm::dvec3& at, double radius) {
    std::vector<Point2> points;
    for (int i = 0; i <= 12; ++i) {
        const double angle = std::numbers::pi * (i / 12.0 - 0.5);
        points.push_back(radius * Point2(std::cos(angle), std::sin(angle)));
    }
    b.lathe({points}, 16, at);
}

// A surface y = height(x, z) of 20 m by 20 m.
inline void terrain(MeshBuilder& b, const std::function<double(double, double)>& height) {
    b.smooth_patch(40, 40,
                   [&](double u, double v) {
                       const double x = 20.0 * u - 10.0, z = 10.0 - 20.0 * v;
                       return glm::dvec3(x, height(x, z), z);
                   },
                   {1.0, 1.0});
}

// `visit` of the places in a grid of `count` places an axis.
inline void each_place(const glm::ivec3& count,
                       const std::function<void(const glm::dvec3&)>& visit) {
    for (int i = 0; i < count.x * count.y * count.z; ++i) {
        visit({i % count.x, i / count.x % count.y, i / count.x / count.y});
    }
}

struct Case {
    const char* name;
    Scene scene;
};

inline void expect_interior(const std::vector<Case>& cases, bool interior) {
    for (const Case& c : cases) {
        const Enclosure seen = enclosure_of(c.scene, bounds(c.scene));
        EXPECT_EQ(seen.kind == SceneKind::interior, interior)
            << c.name << ": within " << seen.within << ", open " << seen.open << "; "
            << seen.reason;
    }
}

}  // namespace kilolux
