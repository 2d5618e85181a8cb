// SPDX-License-Identifier: Apache-2.0
// Cross products of exact differences, against long double.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/certify/synthetic/run_probe.h"
#include "host/gpu/buffer.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

constexpr std::string_view kTwofoldHeaders[] = {"kernels/shadows/shadow_triangle.h"};
constexpr std::string_view kTwofoldProbe = R"(
kernel void probe(global const float* in, global float* out) {
    size_t i = get_global_id(0);
    FV3 v[3];
    for (uint k = 0; k < 3; ++k) v[k] = splat3(vload3(3 * i + k, in));
    FV3 c = twofold_cross(twofold_difference(v[1], v[0]), twofold_difference(v[2], v[0]));
    vstore3((float3)(lane_max(c.x), lane_max(c.y), lane_max(c.z)), i, out);
}
)";

// Triangles with all ratios of height to length down to a float's last place.
std::vector<float> thin_triangles(std::size_t count) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-1.0, 1.0), power(-24.0, 0.0);
    std::vector<float> out;
    for (std::size_t i = 0; i < count; ++i) {
        double origin[3], along[3];
        for (int axis = 0; axis < 3; ++axis) {
            origin[axis] = place(random);
            along[axis] = place(random);
        }
        const double height = std::exp2(power(random)), share = place(random);
        for (const double* at : {origin, along}) {
            for (int axis = 0; axis < 3; ++axis) {
                const double moved = at == along ? origin[axis] + along[axis] : at[axis];
                out.push_back(static_cast<float>(moved));
            }
        }
        for (int axis = 0; axis < 3; ++axis) {
            out.push_back(
                static_cast<float>(origin[axis] + share * along[axis] + height * place(random)));
        }
    }
    return out;
}

TEST(Twofold, CrossProductsAreAsAccurateAsTheySay) {
    constexpr std::size_t kCount = 20000;
    const std::vector<float> in = thin_triangles(kCount);
    const auto found = at_every_width([&](const Gpu& gpu) {
        return run_probe<float>(gpu, {kTwofoldHeaders, kTwofoldProbe}, kCount, 3 * kCount, in);
    });
    for (std::size_t i = 0; i < kCount; ++i) {
        const float* v = in.data() + 9 * i;
        long double a[3], b[3];
        for (int axis = 0; axis < 3; ++axis) {
            a[axis] = static_cast<long double>(v[3 + axis]) - v[axis];
            b[axis] = static_cast<long double>(v[6 + axis]) - v[axis];
        }
        long double off = 0.0L, length = 0.0L, products = 0.0L;
        for (int axis = 0; axis < 3; ++axis) {
            const int j = (axis + 1) % 3, k = (axis + 2) % 3;
            const long double exact = a[j] * b[k] - a[k] * b[j];
            off = std::hypot(off, exact - found[3 * i + static_cast<std::size_t>(axis)]);
            length = std::hypot(length, exact);
            products += std::abs(a[j] * b[k]) + std::abs(a[k] * b[j]);
        }
        ASSERT_LE(off, std::exp2(-22.0L) * length + std::exp2(-44.0L) * products) << i;
    }
}

}  // namespace
}  // namespace kilolux
