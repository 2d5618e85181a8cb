// SPDX-License-Identifier: Apache-2.0
// Shafts from a light to boxes of points leave out no triangle that hides one of the points.
#include "kernels/shared/shadow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <random>

#include "host/certify/synthetic/run_probe.h"
#include "host/gpu/buffer.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

constexpr std::string_view kShaftHeaders[] = {"kernels/shadows/shadow_triangle.h",
                                              "kernels/shadows/shadow_shaft.h"};
// 1: the triangle hides the box's high corner, as a ray's test finds it; 2: the shaft keeps it.
constexpr std::string_view kShaftProbe = R"(
kernel void probe(global const float* in, global int* out) {
    size_t i = get_global_id(0);
    FV3 v[3];
    for (uint k = 0; k < 3; ++k) v[k] = splat3(vload3(6 * i + k, in));
    ShadowLight light = {vload3(6 * i + 3, in), 0.0f, 4.0f, false};
    float3 low = vload3(6 * i + 4, in), high = vload3(6 * i + 5, in);
    MASK sure;
    ShadowTriangles t = set_up_shadow(v, shared_light(light), 4.0f, &sure);
    FV3 p = splat3(high);
    FV3 to = sub3(p, splat3(light.at));
    MASK hides = lane_mask(dot3(t.plane.g, p) + t.plane.c >= fv(-1.0f));
    for (uint k = 0; k < 3; ++k) hides &= lane_mask(dot3(t.edge[k].g, to) >= -size3(to));
    bool keeps = lane_any(may_shade(make_shaft(light, low, high), &t));
    out[i] = (lane_any(hides) ? 1 : 0) | (keeps ? 2 : 0);
}
)";

// Triangles one edge of which passes beside the ray from the light to the high corner by a few
// roundings; boxes of all sizes down to a float's last place.
std::vector<float> triangles_beside_rays(std::size_t count) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(0.1, 1.0), sign(-1.0, 1.0), power(-24.0, 0.0);
    const auto any = [&] { return glm::dvec3(sign(random), sign(random), sign(random)); };
    std::vector<float> out;
    const auto put = [&](const glm::dvec3& v) {
        for (int axis = 0; axis < 3; ++axis) out.push_back(static_cast<float>(v[axis]));
    };
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 light = any();
        const glm::dvec3 to(unit(random), unit(random), unit(random));
        const glm::dvec3 along = any();
        const glm::dvec3 aside = glm::normalize(glm::cross(to, along));
        const double off = 0x1p-18 * sign(random);
        const glm::dvec3 middle = light + 0.5 * to + off * aside;
        put(middle - along);
        put(middle + along);
        put(middle + aside);
        put(light);
        put(light + (1.0 - std::exp2(power(random))) * to);
        put(light + to);
    }
    return out;
}

TEST(ShadowShaft, KeepsTrianglesThatHideAPoint) {
    constexpr std::size_t kCount = 20000;
    const std::vector<float> in = triangles_beside_rays(kCount);
    const auto all = at_every_width([&](const Gpu& gpu) {
        return run_probe<int>(gpu, {kShaftHeaders, kShaftProbe}, kCount, kCount, in);
    });
    int hidden = 0;
    for (const int found : all) {
        ASSERT_NE(found, 1);
        hidden += found & 1;
    }
    EXPECT_GT(hidden, 5000);
    EXPECT_LT(hidden, 19000);
}

}  // namespace
}  // namespace kilolux
