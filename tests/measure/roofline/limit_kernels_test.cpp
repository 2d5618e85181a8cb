// SPDX-License-Identifier: Apache-2.0
// The divisors of measured rates: the operations and bytes of kernels/limits/measure_limits.cl,
// compiled as C++ with lanes that count.
#include "host/measure/roofline/limit_kernels.h"

#include <gtest/gtest.h>

#include <vector>

#include "host/measure/roofline/independent_limits.h"
#include "tests/measure/roofline/counting_lanes.h"

// Words of OpenCL C.
#define KILOLUX_DEVICE_LANES_H
#define kernel inline
#define global
#define restrict
#define VW 8
#define lane_numbers 0u
#define lane_to_float(u) (counting::FV{float(u), true})
#define get_global_id(dimension) 0u
#define lane_load(place) counted_load(place)
#define lane_store(value, place) counted_store(value, place)
namespace limit_source {
using namespace counting;
inline FV operator+(FV a, float b) { return a + fv(b); }
inline FV operator-(FV a, float b) { return a - fv(b); }
inline FV operator*(FV a, float b) { return a * fv(b); }
inline FV counted_load(const float* place) {
    counts.loaded_lanes += VW;
    return {*place, true};
}
inline void counted_store(FV value, float* place) {
    counts.stored_lanes += VW;
    *place = value.value;
}
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include "kernels/limits/measure_limits.cl"
#pragma GCC diagnostic pop
}  // namespace limit_source
#undef kernel
#undef global
#undef restrict
#undef VW

namespace {

using counting::Counts;

// Operations of iterations beyond the first.
template <typename Kernel>
kilolux::InstructionCounts of_ten_iterations(Kernel kernel) {
    float out[8] = {};
    counting::counts = {};
    kernel(1u, 0.75f, 0.25f, out);
    const auto once = counting::counts.instructions;
    counting::counts = {};
    kernel(11u, 0.75f, 0.25f, out);
    return counting::counts.instructions + -1.0 * once;
}

TEST(LimitKernels, DoTheOperationsThatRatesDivideBy) {
    using namespace limit_source;
    const double chains = kilolux::kFmaChains;
    EXPECT_EQ(of_ten_iterations(fma_rate).total, 10.0 * chains);
    EXPECT_EQ(of_ten_iterations(instruction_rate).total, 10.0 * (chains + kilolux::kAddChains));
    EXPECT_EQ(of_ten_iterations(rsqrt_rate).rsqrts, 10.0 * chains);
    EXPECT_EQ(of_ten_iterations(sqrt_rate).sqrts, 10.0 * chains);
    EXPECT_EQ(of_ten_iterations(division_rate).divisions, 10.0 * chains);
}

TEST(LimitKernels, MoveTheBytesThatBandwidthsDivideBy) {
    constexpr unsigned kRepeats = 3, kCount = 8;
    constexpr double kLanes = 3.0 * 8.0 * 8.0;  // repeats, vectors, lanes of a vector
    std::vector<float> to(8 * 8), from(8 * 8);
    float out[8] = {};
    const auto move = [&](auto kernel) {
        counting::counts = {};
        kernel(kRepeats, kCount, kCount, 1u, to.data(), from.data(), out);
        return counting::counts;
    };
    const Counts read = move(limit_source::read_memory);
    EXPECT_EQ(read.loaded_lanes, kLanes);
    EXPECT_EQ(read.stored_lanes, 8.0) << "the sum only";
    const Counts written = move(limit_source::write_memory);
    EXPECT_EQ(written.loaded_lanes, 0.0);
    EXPECT_EQ(written.stored_lanes, kLanes);
    const Counts copied = move(limit_source::copy_memory);
    EXPECT_EQ(copied.loaded_lanes, kLanes);
    EXPECT_EQ(copied.stored_lanes, kLanes);
}

TEST(LimitCheck, FailsAtAFactorOfTwo) {
    for (const double ratio : {0.5, 2.0}) {
        EXPECT_FALSE((kilolux::LimitCheck{"", ratio, 1.0}.agrees(kilolux::kLimitFactor))) << ratio;
    }
    for (const double ratio : {0.8, 1.0, 1.25}) {
        EXPECT_TRUE((kilolux::LimitCheck{"", ratio, 1.0}.agrees(kilolux::kLimitFactor))) << ratio;
    }
    EXPECT_FALSE((kilolux::LimitCheck{"", 1.0, 0.0}.agrees(kilolux::kLimitFactor)));
}

}  // namespace
