// SPDX-License-Identifier: Apache-2.0
// Slices of depths: the device at every lane width, the host's copy of the formula, and the
// definition.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "host/certify/synthetic/host_lists.h"
#include "host/certify/synthetic/run_probe.h"
#include "host/gpu/buffer.h"
#include "host/stages/lists/build_clusters.h"
#include "tests/support/full.h"
#include "tests/support/slice_search.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

constexpr std::string_view kSliceHeaders[] = {"kernels/device/lanes.h",
                                              "kernels/shared/cluster_grid.h"};
constexpr std::string_view kSliceProbe = R"(
kernel void probe(ClusterGrid grid, global const float* z, global uint* out) {
    size_t first = get_global_id(0) * VW;
    lane_store(slice_of_depth(grid, lane_load(z + first)), out + first);
}
)";

std::vector<GridRequest> requests() {
    return {{16, 9, 4, 0.1f, 100.0f, 0.0f},        {16, 9, 1, 1.0f, 1024.0f, 0.0f},
            {4, 4, 64, 0.3f, 1e7f, 0.0f},          {8, 8, 4, 1e-3f, 1e4f, 0.0f},
            {1, 1, 8, 5.0f, 5.0f, 0.0f},           {1, 1, 2, 1e-35f, 1e35f, 0.0f},
            {1, 1, 16, 0x1.8p-3f, 70.0f, 0.0f},    {3, 3, 3, 0.1f, 100.0f, 0.0f},
            {4, 4, 7, 0x1.fffffep-1f, 1e4f, 0.0f}, {1, 1, 63, 1e-3f, 50.0f, 0.0f}};
}

std::vector<uint> device_slices(int lanes, const ClusterGrid& grid, std::vector<float> z) {
    const std::size_t count = z.size();
    z.resize(round_up(count, 16), 1.0f);
    const Gpu gpu = test_gpu(lanes);
    auto slices = run_probe<uint>(gpu, {kSliceHeaders, kSliceProbe}, z.size() / lanes_of(gpu),
                                  z.size(), grid, z);
    slices.resize(count);
    return slices;
}

// Every slice's end and what lies up to 200 steps of the float beside it.
std::vector<float> depths_at_boundaries(const ClusterGrid& grid) {
    std::vector<float> depths;
    for (uint slice = 0; slice <= grid.slices; ++slice) {
        const uint bits = std::bit_cast<uint>(depth_of_slice(grid, slice));
        for (uint step = 0; step <= 400; ++step) {
            depths.push_back(std::bit_cast<float>(bits - 200 + step));
        }
    }
    return depths;
}

std::vector<float> odd_depths() {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    return {0.0f,
            -0.0f,
            -1.0f,
            -1e30f,
            -kInfinity,
            1e-40f,
            -1e-40f,
            1e-38f,
            kInfinity,
            std::numeric_limits<float>::max(),
            std::numeric_limits<float>::denorm_min()};
}

void expect_slices(const ClusterGrid& grid, const std::vector<float>& depths) {
    std::vector<std::vector<uint>> found;
    for (const int lanes : lane_widths()) found.push_back(device_slices(lanes, grid, depths));
    for (std::size_t i = 0; i < depths.size(); ++i) {
        const uint expected = slice_by_search(grid, depths[i]);
        ASSERT_EQ(slice_of_depth(grid, depths[i]), expected) << "host, z = " << depths[i];
        for (const auto& slices : found) ASSERT_EQ(slices[i], expected) << "z = " << depths[i];
    }
}

TEST(Slice, HostAndDeviceAgreeAtEveryBoundary) {
    for (const GridRequest& request : requests()) {
        const ClusterGrid grid = make_cluster_grid(request, 640, 480);
        expect_slices(grid, depths_at_boundaries(grid));
    }
}

TEST(Slice, HostAndDeviceAgreeOnOddDepths) {
    for (const GridRequest& request : requests()) {
        expect_slices(make_cluster_grid(request, 640, 480), odd_depths());
    }
}

TEST(Slice, DepthThatIsNoNumberStaysWithinTheGrid) {
    const ClusterGrid grid = make_cluster_grid({}, 640, 480);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const int lanes : lane_widths()) {
        for (const uint slice : device_slices(lanes, grid, std::vector<float>(16, nan))) {
            EXPECT_LT(slice, grid.slices) << lanes << " lanes";
        }
    }
    EXPECT_LT(slice_of_depth(grid, nan), grid.slices);
}

TEST(Slice, HostAndDeviceAgreeOnAMillionRandomDepths) {
    Random random(5);
    std::vector<float> depths;
    for (int i = 0; i < 1000000; ++i) {
        depths.push_back(static_cast<float>(random.log_uniform(1e-4, 1e5)));
    }
    expect_slices(make_cluster_grid({16, 9, 4, 0.1f, 1000.0f, 0.0f}, 640, 480), depths);
}

TEST(Slice, DepthsDoubleEveryOctaveAndGrowInBetween) {
    for (const GridRequest& request : requests()) {
        const ClusterGrid grid = make_cluster_grid(request, 640, 480);
        const uint per_octave = grid.slices_per_octave;
        ASSERT_EQ(depth_of_slice(grid, 0),
                  request.z_first < 0x1p-100f ? 0x1p-100f : request.z_first);
        for (uint slice = 0; slice < grid.slices; ++slice) {
            const double begin = depth_of_slice(grid, slice);
            ASSERT_LT(begin, depth_of_slice(grid, slice + 1));
            ASSERT_EQ(2.0 * begin, depth_of_slice(grid, slice + per_octave)) << "slice " << slice;
        }
        ASSERT_LE(depth_of_slice(grid, grid.slices - 1), std::min(request.z_last, 0x1p100f));
        ASSERT_GT(depth_of_slice(grid, grid.slices), std::min(request.z_last, 0x1p100f));
    }
}

}  // namespace
}  // namespace kilolux
