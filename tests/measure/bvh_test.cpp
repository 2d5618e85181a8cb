// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace kilolux {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

bool any(const RayHit&) { return true; }

glm::dvec3 random_point(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> unit(-size, size);
    return {unit(random), unit(random), unit(random)};
}

std::vector<BvhTriangle> soup(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<BvhTriangle> out;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 center = random_point(random, 10.0);
        BvhTriangle triangle;
        for (auto& corner : triangle.corners) corner = center + random_point(random, 1.5);
        triangle.triangle = static_cast<std::uint32_t>(i);
        out.push_back(triangle);
    }
    return out;
}

// Distance along the ray by the plane equation and three half-space tests; infinity for a miss.
double direct_distance(const Ray& ray, const BvhTriangle& triangle) {
    const auto& [a, b, c] = triangle.corners;
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const double t = glm::dot(n, a - ray.origin) / glm::dot(n, ray.direction);
    const glm::dvec3 p = ray.origin + t * ray.direction;
    const bool inside = glm::dot(glm::cross(b - a, p - a), n) >= 0 &&
                        glm::dot(glm::cross(c - b, p - b), n) >= 0 &&
                        glm::dot(glm::cross(a - c, p - c), n) >= 0;
    return inside && t >= ray.t_min && t <= ray.t_max ? t : kInf;
}

TEST(Bvh, FindsTheNearestOfEveryTriangle) {
    for (const int count : {1, 2, 5, 17, 1000}) {
        const auto triangles = soup(count, static_cast<unsigned>(count));
        const Bvh bvh(triangles);
        ASSERT_EQ(bvh.triangles().size(), triangles.size());
        std::mt19937 random(99);
        int hits = 0;
        for (int i = 0; i < 2000; ++i) {
            const auto& aim = triangles[random() % triangles.size()].corners;
            const glm::dvec3 eye = random_point(random, 12.0);
            const glm::dvec3 at = (aim[0] + aim[1] + aim[2]) / 3.0 + random_point(random, 0.5);
            const Ray ray{eye, at - eye, 0.1, 5.0};
            double nearest = kInf;
            for (const auto& t : triangles) nearest = std::min(nearest, direct_distance(ray, t));
            const auto hit = bvh.nearest(ray, any);
            ASSERT_EQ(hit.has_value(), nearest < kInf) << "ray " << i << " of " << count;
            if (!hit) continue;
            ++hits;
            ASSERT_NEAR(hit->t, nearest, 1e-9 * nearest) << "ray " << i << " of " << count;
            const auto& corners = bvh.triangles()[hit->index].corners;
            const glm::dvec3 point = hit->weights[0] * corners[0] + hit->weights[1] * corners[1] +
                                     hit->weights[2] * corners[2];
            ASSERT_LT(glm::distance(point, ray.origin + hit->t * ray.direction), 1e-9);
        }
        EXPECT_GT(hits, 30);
        EXPECT_LT(hits, 2000);
    }
}

// A height field of unit squares, moved by up to `jitter`, with every corner first in some
// triangle.
struct HeightField {
    static constexpr int kSize = 12;
    std::vector<glm::dvec3> grid;
    std::vector<BvhTriangle> triangles;

    HeightField(double jitter, unsigned seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit;
        for (int i = 0; i < (kSize + 1) * (kSize + 1); ++i) {
            grid.emplace_back(i % (kSize + 1) + jitter * unit(random),
                              i / (kSize + 1) + jitter * unit(random), unit(random));
        }
        const auto add = [&](std::array<glm::dvec3, 3> corners) {
            std::rotate(corners.begin(), corners.begin() + random() % 3, corners.end());
            triangles.push_back({corners, 0, 0});
        };
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                add({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
                add({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
            }
        }
    }
    glm::dvec3 at(int x, int y) const {
        return grid[static_cast<std::size_t>(y * (kSize + 1) + x)];
    }
};

// Rays through corners and, as exactly as floats allow, through edges: on the field without jitter
// straight down, where the edge functions are 0.
TEST(Bvh, NothingSlipsThroughSharedEdgesAndCorners) {
    for (const double jitter : {0.0, 0.3}) {
        const HeightField field(jitter, 4);
        const Bvh bvh(field.triangles);
        std::mt19937 random(5);
        for (int i = 0; i < 20000; ++i) {
            const auto inner = [&] { return 1 + static_cast<int>(random() % (field.kSize - 1)); };
            const int x = inner(), y = inner();
            const int step_x = static_cast<int>(random() % 2),
                      step_y = static_cast<int>(random() % 2);
            const double share = 0.125 * static_cast<double>(random() % 8);
            const glm::dvec3 target =
                glm::mix(field.at(x, y), field.at(x - step_x, y - step_y), share);
            for (const glm::dvec3& eye :
                 {glm::dvec3(target.x, target.y, 100.0), glm::dvec3(3.0, 4.0, 50.0)}) {
                const Ray ray{eye, target - eye, 0.0, 2.0};
                ASSERT_TRUE(bvh.nearest(ray, any))
                    << "ray " << i << " to " << target.x << ' ' << target.y << ' ' << target.z;
            }
        }
    }
}

TEST(Bvh, AxisParallelRaysInTheFacesOfBoxes) {
    const BvhTriangle floor{{glm::dvec3(0, 0, 0), glm::dvec3(4, 0, 0), glm::dvec3(0, 0, 4)}, 0, 0};
    const BvhTriangle wall{{glm::dvec3(0, 0, 0), glm::dvec3(4, 0, 0), glm::dvec3(0, 4, 0)}, 0, 1};
    const Bvh bvh({floor, wall});
    EXPECT_TRUE(bvh.nearest({{0, 5, 1}, {0, -1, 0}, 0, 10}, any));
    EXPECT_TRUE(bvh.nearest({{1, 5, 0}, {0, -1, 0}, 0, 10}, any));
    EXPECT_TRUE(bvh.nearest({{1, 1, 7}, {0, 0, -1}, 0, 10}, any));
    EXPECT_FALSE(bvh.nearest({{-1e-9, 1, 7}, {0, 0, -1}, 0, 10}, any));
    EXPECT_TRUE(bvh.nearest({{1, 1, -5}, {0, 0, -1}, -10, 10}, any)) << "negative t is allowed";
}

TEST(Bvh, LimitsAndAcceptanceFilterHits) {
    std::vector<BvhTriangle> layers;
    for (std::uint32_t i = 0; i < 40; ++i) {
        const double z = -1.0 - i;
        layers.push_back(
            {{glm::dvec3(-9, -9, z), glm::dvec3(9, -9, z), glm::dvec3(0, 9, z)}, 0, i});
    }
    const Bvh bvh(layers);
    const Ray ray{{0, 0, 0}, {0, 0, -1}, 3.5, 20.0};
    const auto source = [&](const RayHit& hit) { return bvh.triangles()[hit.index].triangle; };
    EXPECT_EQ(source(*bvh.nearest(ray, any)), 3u);
    const auto hit = bvh.nearest(ray, [&](const RayHit& h) { return source(h) >= 11; });
    EXPECT_EQ(source(*hit), 11u);
    EXPECT_FALSE(bvh.nearest(ray, [&](const RayHit& h) { return source(h) >= 20; }));
    EXPECT_EQ(source(*bvh.nearest({ray.origin, ray.direction, 40.0, kInf}, any)), 39u);
}

TEST(Bvh, FirstDrawnWinsATie) {
    const std::array<glm::dvec3, 3> corners = {glm::dvec3(-1, -1, -2), glm::dvec3(1, -1, -2),
                                               glm::dvec3(0, 1, -2)};
    std::vector<BvhTriangle> same;
    for (std::uint32_t i = 0; i < 20; ++i) same.push_back({corners, 20 - i, 5});
    const Bvh bvh(same);
    const auto hit = bvh.nearest({{0, 0, 0}, {0, 0, -1}, 0, kInf}, any);
    ASSERT_TRUE(hit);
    EXPECT_EQ(bvh.triangles()[hit->index].instance, 1u);
}

TEST(Bvh, LeavesOutWhatHasNoExtent) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const glm::dvec3 a(0, 0, -1), b(1, 0, -1), c(0, 1, -1);
    const Bvh bvh({{{a, a, b}, 0, 0},
                   {{a, b, glm::dvec3(2, 0, -1)}, 0, 1},
                   {{a, b, glm::dvec3(nan, 0, 0)}, 0, 2},
                   {{a, b, glm::dvec3(kInf, 0, 0)}, 0, 3},
                   {{a, b, c}, 0, 4}});
    ASSERT_EQ(bvh.triangles().size(), 1u);
    EXPECT_EQ(bvh.triangles()[0].triangle, 4u);
    EXPECT_FALSE(Bvh({}).nearest({{0, 0, 0}, {0, 0, -1}, 0, kInf}, any));
}

}  // namespace
}  // namespace kilolux
