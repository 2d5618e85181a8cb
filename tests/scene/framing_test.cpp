// SPDX-License-Identifier: Apache-2.0
// Cameras for scenes that have none: an object whole from outside, an interior from inside.
#include "host/scene/framing.h"

#include <gtest/gtest.h>

#include "host/scene/enclosure.h"
#include "host/scene/generated/scenes.h"
#include "host/scene/look_around.h"
#include "tests/support/box_scene.h"

namespace kilolux {
namespace {

bool lies_within(const Box& box, const glm::dvec3& p) {
    return glm::all(glm::greaterThan(p, box.min)) && glm::all(glm::lessThan(p, box.max));
}

// Largest |ndc x| and |ndc y| of the box's corners; infinite where one is behind the camera.
glm::dvec2 extent(const Camera& camera, const Box& box, double aspect) {
    glm::dvec2 most(0.0);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p((corner & 1) != 0 ? box.max.x : box.min.x,
                           (corner & 2) != 0 ? box.max.y : box.min.y,
                           (corner & 4) != 0 ? box.max.z : box.min.z);
        const glm::dvec3 v = (p - camera.position) * camera.world_from_view;
        if (v.z > -camera.z_near) return glm::dvec2(std::numeric_limits<double>::infinity());
        const double half = std::tan(0.5 * camera.y_fov);
        most = glm::max(
            most, glm::dvec2(std::abs(v.x / v.z) / (half * aspect), std::abs(v.y / v.z) / half));
    }
    return most;
}

TEST(Framing, AnObjectIsSeenWholeFromOutsideInEveryShapeOfPicture) {
    for (const glm::dvec3 size : {glm::dvec3(1e-3), glm::dvec3(1.0), glm::dvec3(1e4),
                                  glm::dvec3(9.0, 0.1, 1.0), glm::dvec3(0.1, 9.0, 0.1)}) {
        const Scene scene = box_scene(size);
        for (const double aspect : {0.3, 1.0, 16.0 / 9.0, 4.0}) {
            const Camera camera = framing_camera(scene, aspect);
            const glm::dvec2 most = extent(camera, bounds(scene), aspect);
            EXPECT_LE(std::max(most.x, most.y), 1.0) << size.x << " aspect " << aspect;
            EXPECT_GE(std::max(most.x, most.y), 0.9) << size.x << " aspect " << aspect;
            EXPECT_FALSE(lies_within(bounds(scene), camera.position));
        }
    }
}

TEST(Framing, AnInteriorIsSeenFromInsideAlongItsLongestView) {
    const Scene scene = box_scene({4.0, 5.0, 30.0}, true);
    const Camera camera = framing_camera(scene, 1.5);
    EXPECT_TRUE(lies_within(bounds(scene), camera.position));
    EXPECT_GT(std::abs(camera.world_from_view[2].z), 0.98);
    EXPECT_GT(std::abs(camera.position.z), 8.0) << "near one end";
    EXPECT_LT(camera.position.z * camera.world_from_view[2].z, 1e9);
    EXPECT_GT(camera.position.z * camera.world_from_view[2].z, 0.0) << "and looks at the other";
    EXPECT_LT(camera.position.y, 0.0);
}

TEST(Framing, KindsOfScenes) {
    EXPECT_EQ(box_scene(glm::dvec3(2.0)).kind, SceneKind::closed);
    EXPECT_EQ(box_scene(glm::dvec3(2.0), true).kind, SceneKind::interior);
    EXPECT_EQ(box_scene({2.0, 0.0, 2.0}).kind, SceneKind::open);
    EXPECT_EQ(enclosure_of(Scene{}, Box{}).kind, SceneKind::open);
    const Scene atrium = make_generated_scene("atrium");
    EXPECT_EQ(enclosure_of(atrium, bounds(atrium)).kind, SceneKind::interior);
    // No coordinate is too large; NaN is not seen.
    for (const double at : {1e15, 1e30, 1e200, std::nan("")}) {
        Scene far = box_scene(glm::dvec3(2.0), true);
        far.instances.push_back({0, glm::dmat4(1.0)});
        far.instances[1].world_from_object[3] = {at, 0.0, 0.0, 1.0};
        EXPECT_EQ(enclosure_of(far, bounds(far)).kind == SceneKind::interior, std::isnan(at)) << at;
    }
    // Mirroring an instance turns its winding, but the kind of scene stays.
    Scene mirrored = box_scene(glm::dvec3(2.0), true);
    mirrored.instances[0].world_from_object[0][0] = -1.0;
    EXPECT_EQ(enclosure_of(mirrored, bounds(mirrored)).kind, SceneKind::interior);
    // Glass encloses nothing.
    Scene glass = box_scene(glm::dvec3(2.0));
    glass.materials[0].alpha_mode = AlphaMode::blend;
    EXPECT_EQ(enclosure_of(glass, bounds(glass)).kind, SceneKind::open);
}

TEST(Framing, RaysMeetWhatTheyShould) {
    const Scene scene = box_scene({6.0, 4.0, 2.0}, true);
    const LookAround around(scene, bounds(scene));
    const glm::dvec3 eye(1.0, -0.5, 0.0);
    EXPECT_EQ(around.first_hit(eye, {0.3, 1.0, 0.1}).side, LookAround::Side::front);
    EXPECT_EQ(around.first_hit({9.0, 0.0, 0.0}, {-1.0, 0.1, 0.1}).side, LookAround::Side::back);
    EXPECT_EQ(around.first_hit({9.0, 0.0, 0.0}, {1.0, 0.1, 0.1}).side, LookAround::Side::none);
    EXPECT_NEAR(around.below(eye), 1.5, 0.02);
    for (const LookAround::Level& level : around.level(eye)) {
        const glm::dvec3 d = level.direction;
        const double x = d.x > 0.0 ? 2.0 / d.x : -4.0 / d.x;
        const double z = 1.0 / std::abs(d.z);
        EXPECT_NEAR(level.distance / std::min(x, z), 1.0, 0.01) << d.x << " " << d.z;
    }
}

TEST(Framing, FitKeepsTheFieldAskedFor) {
    const double y = 0.7, half = std::tan(0.35);
    for (const double made_for : {0.5, 1.0, 2.0}) {
        for (const double aspect : {0.6, 1.7}) {
            const auto shown = [&](Fit fit) {
                const double half_y = std::tan(0.5 * fitted_y_fov(y, made_for, aspect, fit));
                return glm::dvec2(half_y * aspect, half_y);
            };
            EXPECT_DOUBLE_EQ(shown(Fit::height).y, half);
            EXPECT_NEAR(shown(Fit::width).x, half * made_for, 1e-12);
            const glm::dvec2 both = shown(Fit::both);
            EXPECT_NEAR(std::min(both.x / (half * made_for), both.y / half), 1.0, 1e-12);
            EXPECT_NEAR(fitted_y_extent(3.0, made_for, aspect, Fit::width), 3.0 * made_for / aspect,
                        1e-12);
        }
    }
    EXPECT_EQ(fitted_y_fov(y, 0.0, 2.0, Fit::width), y) << "made for no aspect";
}

}  // namespace
}  // namespace kilolux
