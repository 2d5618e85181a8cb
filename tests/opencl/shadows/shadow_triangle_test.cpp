// SPDX-License-Identifier: Apache-2.0
// Which rays pass a triangle's box, against double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <random>

#include "host/certify/synthetic/run_probe.h"
#include "host/gpu/buffer.h"
#include "kernels/shared/shadow.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

constexpr std::string_view kTriangleHeaders[] = {"kernels/shadows/shadow_triangle.h"};
constexpr std::string_view kTriangleProbe = R"(
kernel void probe(global const float* in, uint is_direction, global int* out) {
    size_t i = get_global_id(0);
    ShadowLight light = {vload3(4 * i + 1, in), 0.0f, 2.0f, is_direction != 0u};
    LaneBoxes box = {splat3(vload3(4 * i + 2, in)), splat3(vload3(4 * i + 3, in))};
    out[i] = lane_any(passes_box(shared_light(light), splat3(vload3(4 * i, in)), box)) ? 1 : 0;
}
)";

struct Ray {
    glm::vec3 point, light, middle, half_edge;
};

std::vector<int> passes_on_device(const std::vector<Ray>& rays, bool are_directions) {
    std::vector<float> in;
    for (const Ray& ray : rays) {
        for (const glm::vec3& v : {ray.point, ray.light, ray.middle, ray.half_edge}) {
            in.insert(in.end(), {v.x, v.y, v.z});
        }
    }
    return at_every_width([&](const Gpu& gpu) {
        return run_probe<int>(gpu, {kTriangleHeaders, kTriangleProbe}, rays.size(), rays.size(), in,
                              are_directions ? 1u : 0u);
    });
}

// By the box's slabs; the box is wider by `pad`.
bool passes(const Ray& ray, bool is_direction, double pad) {
    const glm::dvec3 p(ray.point), light(ray.light);
    const glm::dvec3 d = is_direction ? light : light - p;
    double first = 0.0, last = is_direction ? std::numeric_limits<double>::infinity() : 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double half = ray.half_edge[axis] + pad;
        const double a = (ray.middle[axis] - half - p[axis]) / d[axis];
        const double b = (ray.middle[axis] + half - p[axis]) / d[axis];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return first <= last;
}

// Coordinates are at most 1, so the pad is the same for all.
TEST(ShadowTriangle, RaysPassItsBoxAsInDouble) {
    constexpr double kClose = 0.5 * SHADOW_PAD;
    std::mt19937 random(9);
    std::uniform_real_distribution<float> place(-1.0f, 1.0f), size(0.0f, 0.8f);
    const auto vector = [&](auto& of) { return glm::vec3(of(random), of(random), of(random)); };
    std::vector<Ray> rays;
    for (int i = 0; i < 20000; ++i) {
        rays.push_back({vector(place), vector(place), vector(place), vector(size)});
        rays.back().half_edge[i % 3] = 0.0f;  // of a triangle in a plane of the axes
    }
    for (const bool are_directions : {false, true}) {
        const std::vector<int> found = passes_on_device(rays, are_directions);
        int passing = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const bool does = passes(rays[i], are_directions, 0.0);
            if (does != passes(rays[i], are_directions, 1.2 * kClose)) continue;
            ASSERT_EQ(found[i], does ? 1 : 0) << "ray " << i;
            passing += found[i];
        }
        EXPECT_GT(passing, 500);
        EXPECT_LT(passing, 10000);
    }
}

// Rays that touch a corner of a box pass it, though their points are nearer to the origin, and so
// have finer floats, than light and box.
TEST(ShadowTriangle, RaysThatTouchABoxPassIt) {
    std::mt19937 random(12);
    std::uniform_real_distribution<double> unit(0.05, 1.0), sign(-1.0, 1.0);
    std::vector<Ray> rays;
    while (rays.size() < 20000) {
        Ray ray;
        glm::dvec3 half;
        for (int axis = 0; axis < 3; ++axis) {
            ray.point[axis] = static_cast<float>(1e-5 * sign(random));
            ray.light[axis] = static_cast<float>(std::copysign(unit(random), sign(random)));
            half[axis] = 0.2 * unit(random);
        }
        // The box hangs off the ray by one of its edges.
        const glm::dvec3 p(ray.point), d = glm::dvec3(ray.light) - p;
        const int along = static_cast<int>(rays.size() % 3), across = (along + 1) % 3;
        glm::dvec3 middle = p + 0.6 * d;
        middle[along] += std::copysign(half[along], d[along]);
        middle[across] -= std::copysign(half[across], d[across]);
        ray.middle = glm::vec3(middle);
        ray.half_edge = glm::vec3(half);
        if (passes(ray, false, 0.0)) rays.push_back(ray);
    }
    const std::vector<int> found = passes_on_device(rays, false);
    EXPECT_EQ(std::ranges::count(found, 0), 0);
}

constexpr std::string_view kPlaneProbe = R"(
kernel void probe(global const float* in, global float* out) {
    size_t i = get_global_id(0);
    FV3 v[3];
    for (uint k = 0; k < 3; ++k) v[k] = splat3(vload3(5 * i + k, in));
    ShadowLight light = {vload3(5 * i + 3, in), 0.0f, 300.0f, false};
    MASK sure;
    ShadowTriangles t = set_up_shadow(v, shared_light(light), 1200.0f, &sure);
    out[i] = lane_max(dot3(t.plane.g, splat3(vload3(5 * i + 4, in))) + t.plane.c);
}
)";

// Legs along two axes, far out along the third: one product makes its normal. Its own points,
// rounded to floats, lie in its plane by less than a unit, so that it does not hide them.
TEST(ShadowTriangle, PlanesDoNotHideTheirOwnPoints) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    constexpr std::size_t kRandomTriangles = 6000;
    std::vector<float> in;
    for (std::size_t i = 0; i < kRandomTriangles; ++i) {
        const int a = static_cast<int>(i % 3), b = (a + 1 + static_cast<int>(i / 3 % 2)) % 3;
        const int across = 3 - a - b;
        glm::dvec3 v0(0.0), leg_a(0.0), leg_b(0.0);
        v0[across] = 900.0 + unit(random);
        leg_a[a] = leg_b[b] = 100.0;
        leg_a[across] = 1e-2 * unit(random);
        leg_b[across] = 1e-2 * unit(random);
        glm::dvec3 light = v0 + 30.0 * glm::dvec3(unit(random), unit(random), unit(random));
        light[across] = v0[across] + 100.0;
        const double u = 0.5 * unit(random), w = 0.5 * unit(random);
        for (const glm::dvec3& v :
             {v0, v0 + leg_a, v0 + leg_b, light, v0 + u * leg_a + w * leg_b}) {
            for (int axis = 0; axis < 3; ++axis) in.push_back(static_cast<float>(v[axis]));
        }
    }
    const auto all = at_every_width([&](const Gpu& gpu) {
        return run_probe<float>(gpu, {kTriangleHeaders, kPlaneProbe}, kRandomTriangles,
                                kRandomTriangles, in);
    });
    for (const float behind : all) {
        ASSERT_NEAR(behind, -2.0f, 1.0f);
    }
}

}  // namespace
}  // namespace kilolux
