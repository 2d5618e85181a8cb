// SPDX-License-Identifier: Apache-2.0
// Edges whose products with rays have a certain sign beyond +-1, against long double.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/certify/synthetic/run_probe.h"
#include "host/gpu/buffer.h"
#include "kernels/shared/view.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

constexpr std::string_view kSetUpHeaders[] = {"kernels/surfaces/raster_set_up.h"};
constexpr std::string_view kSetUpProbe = R"(
kernel void probe(View view, global const float* in, global float* out) {
    size_t i = get_global_id(0);
    float3 p = vload3(2 * i, in), q = vload3(2 * i + 1, in);
    FV3 a = fv3(fv(p.x), fv(p.y), fv(p.z)), b = fv3(fv(q.x), fv(q.y), fv(q.z));
    FV3 e = sure_edge(a, b, size3(a) * size3(b), ray_span(view));
    vstore3((float3)(lane_max(e.x), lane_max(e.y), lane_max(e.z)), i, out);
}
)";

// Rays of x in [near, far] and y in [-far, -near]: the view's corners differ in size.
constexpr float kNearPlane = 0.01f, kFarPlane = 3.0f;

View view_beside_the_axis() {
    View view{};
    view.width = view.height = 64;
    const float step = (kFarPlane - kNearPlane) / 64.0f;
    view.ray = {step, kNearPlane, -step, -kNearPlane};
    return view;
}

// Ends of edges that are nearly seen end-on along one of the axes.
std::vector<float> edges_end_on(std::size_t count) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> place(-4.0, 4.0), longer(1.0, 1.5), power(-24.0, -4.0);
    std::vector<float> out;
    for (std::size_t i = 0; i < count; ++i) {
        double a[3] = {place(random), place(random), -1.0 - std::abs(place(random))};
        a[i % 2] *= 1e-4;
        const double times = longer(random), off = std::exp2(power(random));
        for (const double v : a) out.push_back(static_cast<float>(v));
        for (const double v : a) out.push_back(static_cast<float>(v * times + off * place(random)));
    }
    return out;
}

long double product(const float* a, const float* b, const float* ray) {
    const auto at = [](const float* v, int axis) { return static_cast<long double>(v[axis]); };
    long double sum = 0.0L;
    for (int axis = 0; axis < 3; ++axis) {
        const int j = (axis + 1) % 3, k = (axis + 2) % 3;
        sum += (at(a, j) * at(b, k) - at(a, k) * at(b, j)) * at(ray, axis);
    }
    return sum;
}

TEST(RasterSetUp, SignsOfEdgesAreCertainBeyondOne) {
    constexpr std::size_t kEdges = 4000;
    const std::vector<float> in = edges_end_on(kEdges);
    const auto found = at_every_width([&](const Gpu& gpu) {
        return run_probe<float>(gpu, {kSetUpHeaders, kSetUpProbe}, kEdges, 3 * kEdges,
                                view_beside_the_axis(), in);
    });
    std::mt19937 random(8);
    std::uniform_real_distribution<float> place(kNearPlane, kFarPlane);
    int sure = 0;
    for (std::size_t i = 0; i < 100 * kEdges; ++i) {
        const std::size_t edge = i / 100;
        const float ray[3] = {place(random), -place(random), -1.0f};
        const auto e = [&](std::size_t axis) { return double{found[3 * edge + axis]}; };
        const double side = e(0) * ray[0] + e(1) * ray[1] - e(2);
        if (std::abs(side) <= 1.0) continue;
        ++sure;
        const float* a = in.data() + 6 * edge;
        ASSERT_GT(product(a, a + 3, ray) * side, 0.0L) << "edge " << edge << ", ray " << i;
    }
    EXPECT_GT(sure, 100000);
    EXPECT_LT(sure, 390000);
}

}  // namespace
}  // namespace kilolux
