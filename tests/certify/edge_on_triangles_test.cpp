// SPDX-License-Identifier: Apache-2.0
// Triangles whose planes pass so near to the eye that floats do not tell its side.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "host/certify/triangle_coverage.h"
#include "host/scene/camera.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

constexpr int kEdgeOnSize = 24;

// Whole numbers, so that the determinant is exact.
struct Around {
    std::array<glm::i64vec3, 3> v;
    std::int64_t determinant;
};

// A triangle around the eye: v0 + v1 + v2 is a few units long, so det(v0, v1, v2) is the product of
// v0 x v1 and that sum.
Around triangle_around_the_eye(std::mt19937& random) {
    const auto whole = [&](int most) {
        return std::uniform_int_distribution<std::int64_t>(-most, most)(random);
    };
    for (;;) {
        const glm::i64vec3 a(whole(4000000), whole(4000000), whole(4000000));
        const glm::i64vec3 b(whole(4000000), whole(4000000), whole(4000000));
        const glm::i64vec3 sum(whole(1), whole(1), whole(1));
        const glm::i64vec3 n(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
        const std::int64_t determinant = n.x * sum.x + n.y * sum.y + n.z * sum.z;
        if (determinant != 0) return {{a, b, sum - a - b}, determinant};
    }
}

enum class Cover { no, yes, unsure };

// Whether the triangle lies along a ray: the planes of its edges have the determinant's sign.
Cover covers(const Around& triangle, const glm::dvec3& ray) {
    bool all = true, sure = true;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 a(triangle.v[i]), b(triangle.v[(i + 1) % 3]);
        const double u = glm::dot(glm::cross(a, b), ray);
        sure &= std::abs(u) > 1e-4 * glm::length(a) * glm::length(b);
        all &= (u > 0.0) == (triangle.determinant > 0);
    }
    return !sure ? Cover::unsure : all ? Cover::yes : Cover::no;
}

TEST(EdgeOnTriangles, AroundTheEyeCoverTheirSideOfIt) {
    std::mt19937 random(3);
    Camera camera = look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 1.2);
    camera.z_near = 1e-9;
    const View view = view_of(camera, kEdgeOnSize, kEdgeOnSize);
    int covered = 0;
    for (int i = 0; i < 40; ++i) {
        const Around triangle = triangle_around_the_eye(random);
        TriangleMesh mesh{{}, {{0, 1, 2}}};
        for (const glm::i64vec3& v : triangle.v) mesh.vertices.push_back(glm::vec3(v) / 8192.0f);
        const std::vector<int> found = triangle_coverage(test_gpu(), scene_of_triangles(mesh),
                                                         camera, kEdgeOnSize, kEdgeOnSize);
        for (std::size_t pixel = 0; pixel < found.size(); ++pixel) {
            const double x = static_cast<double>(pixel % kEdgeOnSize) + 0.5;
            const double y = static_cast<double>(pixel / kEdgeOnSize) + 0.5;
            const Cover expected =
                covers(triangle, {x * view.ray.x + view.ray.y, y * view.ray.z + view.ray.w, -1.0});
            if (expected == Cover::unsure) continue;
            ASSERT_EQ(found[pixel], expected == Cover::yes ? 1 : 0)
                << "triangle " << i << ", pixel " << pixel;
            covered += found[pixel];
        }
    }
    EXPECT_GT(covered, 1000);
}

}  // namespace
}  // namespace kilolux
