// SPDX-License-Identifier: Apache-2.0
// Codes of tangents: their error, whatever the normal and its rounding.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/certify/synthetic/random.h"
#include "host/certify/synthetic/run_probe.h"
#include "host/gpu/buffer.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

constexpr std::string_view kHeaders[] = {"kernels/device/lanes.h", "kernels/shared/pack.h"};
constexpr std::string_view kProbe = R"(
kernel void probe(global const float* in, uint count, global float* out) {
    uint i = get_global_id(0) * VW;
#define VALUE(row) lane_load(in + (row) * count + i)
    Surface s = default_surface();
    s.normal = fv3(VALUE(0), VALUE(1), VALUE(2));
    s.tangent = fv3(VALUE(3), VALUE(4), VALUE(5));
    s.anisotropy = VALUE(6);
    UV code = pack_anisotropy(s);
    // The normal as the layout `packed` gives it back.
    FV3 o = octahedral_encode(s.normal);
    UV n = pack_normal(o.x, o.y);
    s.normal = octahedral_decode(snorm_of_unorm16(n & 0xffffu), snorm_of_unorm16(n >> 16));
    s = unpack_anisotropy(code, s);
    lane_store(s.tangent.x, out + i);
    lane_store(s.tangent.y, out + count + i);
    lane_store(s.tangent.z, out + 2 * count + i);
    lane_store(s.anisotropy, out + 3 * count + i);
    lane_store(dot3(s.tangent, s.normal), out + 4 * count + i);
}
)";

// Degrees between two lines.
double angle(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), std::abs(glm::dot(a, b))) * 180.0 /
           std::numbers::pi;
}

TEST(Pack, TangentsKeepTheirLine) {
    constexpr std::size_t kCount = 1u << 16;
    Random random(3);
    std::vector<float> in(7 * kCount);
    std::vector<glm::dvec3> normals, tangents;
    for (std::size_t i = 0; i < kCount; ++i) {
        // As seen: towards the viewer or, at the edge of a wide view, a little away.
        glm::dvec3 n;
        do {
            n = random.direction();
        } while (n.z < -0.5);
        if (i % 64 == 0) n = {i % 128 == 0 ? 1.0 : 0.0, 0.0, i % 128 == 0 ? 0.0 : 1.0};
        glm::dvec3 t = glm::normalize(glm::cross(n, random.direction()));
        if (i % 4096 == 0) t = {0, 1, 0};
        const double values[] = {n.x, n.y, n.z, t.x, t.y, t.z, random.unit()};
        for (std::size_t row = 0; row < 7; ++row) {
            in[row * kCount + i] = static_cast<float>(values[row]);
        }
        normals.push_back(n);
        tangents.push_back(t);
    }
    for (const int lanes : {1, 8}) {
        const Gpu gpu = test_gpu(lanes);
        const BuildOptions options = BuildOptions().define("HAS_ANISOTROPY", 1);
        const auto out = run_probe<float>(gpu, {kHeaders, kProbe, options}, kCount / lanes_of(gpu),
                                          5 * kCount, in, static_cast<uint>(kCount));
        double worst = 0.0;
        for (std::size_t i = 0; i < kCount; ++i) {
            const glm::dvec3 t(out[i], out[kCount + i], out[2 * kCount + i]);
            ASSERT_NEAR(glm::length(t), 1.0, 1e-6);
            ASSERT_LT(std::abs(out[4 * kCount + i]), 1e-6) << "perpendicular";
            ASSERT_NEAR(out[3 * kCount + i], in[6 * kCount + i], 0.6 / 65535.0);
            worst = std::max(worst, angle(t, tangents[i]));
        }
        // The code's own 0.0018 degrees, and what the normal's rounding of 0.0038 turns.
        EXPECT_LT(worst, 0.0085);
        EXPECT_GT(worst, 0.003);
    }
}

}  // namespace
}  // namespace kilolux
