// SPDX-License-Identifier: Apache-2.0
// Boxes of the coarse clusters: they hold every pixel's position, and little more.
#include "host/stages/lists/build_clusters.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/base/error.h"
#include "host/certify/synthetic/host_lists.h"
#include "host/certify/synthetic/synthetic.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

struct Interval {
    float lo, hi;
};

struct Boxes {
    std::vector<Interval> columns, rows, depths;
};

Boxes build(const View& view, const ClusterGrid& grid) {
    const Gpu gpu = test_gpu();
    BuildClusters stage(gpu);
    StageTimer timer;
    const ClusterBoxes boxes = stage.enqueue(view, grid, timer);
    return {download<Interval>(gpu, boxes.columns, std::size_t{grid.slices} * grid.tiles_x),
            download<Interval>(gpu, boxes.rows, std::size_t{grid.slices} * grid.tiles_y),
            download<Interval>(gpu, boxes.depths, grid.slices)};
}

std::vector<ViewShape> clustered_shapes() {
    std::vector<ViewShape> all(9);
    all[0] = {640, 480};
    all[1] = {1, 1};
    all[2] = {17, 31};
    all[3] = {1919, 1079, 0.9, 0.5, 0.5, -0.5};
    all[4] = {8192, 1, 3.0, 0.01, -2.0, 0.0};
    all[5] = {333, 222, 12.0, 8.0, 100.0, -3.0, -4.0, 90.0, 0, 0, true};
    all[6] = {64, 64, 1e-3, 1e-3};
    all[7] = {640, 480, 50.0, 40.0, 0, 0, 0.0, 1e4, 0, 0, true};
    // Pixels smaller than the rounding of their rays.
    all[8] = {64, 64, 1e-6, 1e-6, 0.5, -0.25};
    return all;
}

bool holds(Interval interval, double value) {
    // Positions are stored as floats: the neighbours of the exact value belong, too.
    const auto nearest = static_cast<float>(value);
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    return interval.lo <= std::nextafter(nearest, -kInfinity) &&
           interval.hi >= std::nextafter(nearest, kInfinity);
}

// Depths of a slice that a float can have, its ends among them.
std::vector<double> depths_of(const ClusterGrid& grid, uint slice, bool orthographic,
                              Random& random) {
    const double begin = depth_of_slice(grid, slice);
    const float end = depth_of_slice(grid, slice + 1);
    std::vector<double> depths = {begin, static_cast<float>(random.uniform(begin, end)),
                                  std::nextafter(end, 0.0f)};
    if (slice == 0) depths.push_back(orthographic ? -1e4 : 1e-6 * begin);
    if (slice + 1 == grid.slices) depths.push_back(1e7 * begin);
    return depths;
}

void expect_pixels_inside(const View& view, const ClusterGrid& grid, const Boxes& boxes) {
    Random random(3);
    for (uint slice = 0; slice < grid.slices; ++slice) {
        for (const double z : depths_of(grid, slice, view.orthographic != 0, random)) {
            ASSERT_TRUE(boxes.depths[slice].lo <= z && z <= boxes.depths[slice].hi) << "z = " << z;
            const double s = view.orthographic != 0 ? 1.0 : z;
            for (uint x = 0; x < view.width;
                 x += (x % grid.tile_width == grid.tile_width - 1) ? 1 : 5) {
                const double px = ((x + 0.5) * view.ray.x + view.ray.y) * s;
                const uint column = slice * grid.tiles_x + x / grid.tile_width;
                ASSERT_TRUE(holds(boxes.columns[column], px)) << "x " << x << ", z " << z;
            }
            for (uint y = 0; y < view.height;
                 y += (y % grid.tile_height == grid.tile_height - 1) ? 1 : 5) {
                const double py = ((y + 0.5) * view.ray.z + view.ray.w) * s;
                const uint row = slice * grid.tiles_y + y / grid.tile_height;
                ASSERT_TRUE(holds(boxes.rows[row], py)) << "y " << y << ", z " << z;
            }
        }
    }
}

// The exact interval of tile columns [begin, end) over the depths [z0, z1] along x.
void expect_tight(const View& view, const ClusterGrid& grid, const Boxes& boxes) {
    for (uint slice = 1; slice + 1 < grid.slices; ++slice) {
        const double z0 = view.orthographic != 0 ? 1.0 : depth_of_slice(grid, slice);
        const double z1 = view.orthographic != 0 ? 1.0 : depth_of_slice(grid, slice + 1);
        for (uint column = 0; column < grid.tiles_x; ++column) {
            const double a = column * grid.tile_width * double{view.ray.x} + view.ray.y;
            const double b = (column + 1) * grid.tile_width * double{view.ray.x} + view.ray.y;
            const double lo = std::min({a * z0, a * z1, b * z0, b * z1});
            const double hi = std::max({a * z0, a * z1, b * z0, b * z1});
            const double slack =
                2e-6 * z1 * (std::abs(view.ray.y) + std::abs(b)) + grid.position_pad * 1.01;
            const Interval found = boxes.columns[slice * grid.tiles_x + column];
            ASSERT_GE(found.lo, lo - slack) << "slice " << slice << ", column " << column;
            ASSERT_LE(found.hi, hi + slack) << "slice " << slice << ", column " << column;
        }
    }
}

TEST(BuildClusters, BoxesHoldEveryPixelOfTheirTileAndSlice) {
    for (const ViewShape& shape : clustered_shapes()) {
        for (const GridRequest& request :
             {GridRequest{16, 9, 4, 0.1f, 100.0f, 0.0f}, GridRequest{3, 2, 1, 1e-3f, 1e4f, 0.0f},
              GridRequest{64, 64, 16, 0.7f, 9.0f, 0.0f}}) {
            SCOPED_TRACE(std::to_string(shape.width) + "x" + std::to_string(shape.height));
            const View view = make_view(shape);
            const ClusterGrid grid = make_cluster_grid(request, shape.width, shape.height);
            const Boxes boxes = build(view, grid);
            expect_pixels_inside(view, grid, boxes);
            expect_tight(view, grid, boxes);
        }
    }
}

TEST(BuildClusters, NeighboursShareFacesAndTheEndsAreOpen) {
    for (const bool orthographic : {false, true}) {
        ViewShape shape;
        shape.orthographic = orthographic;
        const ClusterGrid grid = make_cluster_grid({4, 4, 4, 0.3f, 30.0f, 0.0f}, 64, 48);
        const Boxes boxes = build(make_view(shape), grid);
        EXPECT_EQ(boxes.depths.front().lo, orthographic ? -Z_UNBOUNDED : 0.0f);
        EXPECT_EQ(boxes.depths.back().hi, Z_UNBOUNDED);
        for (uint slice = 0; slice + 1 < grid.slices; ++slice) {
            EXPECT_EQ(boxes.depths[slice].hi, boxes.depths[slice + 1].lo);
            EXPECT_EQ(boxes.depths[slice].hi, depth_of_slice(grid, slice + 1));
        }
        for (uint column = 0; column + 1 < grid.tiles_x; ++column) {
            EXPECT_GE(boxes.columns[column].hi, boxes.columns[column + 1].lo);
        }
    }
}

TEST(BuildClusters, PositionPadWidensEveryFace) {
    const View view = make_view(ViewShape{});
    GridRequest request{4, 4, 4, 0.3f, 30.0f, 0.0f};
    const ClusterGrid grid = make_cluster_grid(request, 64, 48);
    request.position_pad = 0.25f;
    const ClusterGrid padded_grid = make_cluster_grid(request, 64, 48);
    const Boxes plain = build(view, grid);
    const Boxes padded = build(view, padded_grid);
    for (std::size_t i = 0; i < plain.columns.size(); ++i) {
        EXPECT_LE(padded.columns[i].lo, plain.columns[i].lo - 0.249f);
        EXPECT_GE(padded.columns[i].hi, plain.columns[i].hi + 0.249f);
    }
    for (std::size_t i = 0; i + 1 < plain.depths.size(); ++i) {
        EXPECT_LE(padded.depths[i].lo, plain.depths[i].lo - 0.249f);
        EXPECT_GE(padded.depths[i].hi, plain.depths[i].hi + 0.249f);
    }
}

TEST(BuildClusters, GridNeverFails) {
    const GridRequest wild{0, 100000, 1000, -3.0f, -7.0f, 0.0f};
    for (const auto& [width, height] : {std::pair{1u, 1u}, {8192u, 1u}, {1919u, 1079u}}) {
        const ClusterGrid grid = make_cluster_grid(wild, width, height);
        EXPECT_GE(grid.tiles_x * grid.tile_width, width);
        EXPECT_GE(grid.tiles_y * grid.tile_height, height);
        EXPECT_LT((grid.tiles_x - 1) * grid.tile_width, width);
        EXPECT_LT((grid.tiles_y - 1) * grid.tile_height, height);
        EXPECT_EQ(grid.tile_width % FINE_TILE + grid.tile_height % FINE_TILE, 0u);
        EXPECT_EQ(grid.slices, 1u);
        EXPECT_EQ(grid.slices_per_octave, 64u);
        EXPECT_EQ(grid.cluster_count, grid.tiles_x * grid.tiles_y * grid.slices);
    }
}

TEST(ClusterGrid, MoreTilesOrClustersThan32BitsNumberAreAnError) {
    const auto message_of = [](const GridRequest& request, uint width, uint height) -> std::string {
        try {
            make_cluster_grid(request, width, height);
        } catch (const Error& error) {
            return error.what();
        }
        return "no error";
    };
    const GridRequest absurd{1u << 20, 1u << 20, 64, 1e-30f, 1e30f, 0.0f};
    EXPECT_NE(message_of(absurd, 65536, 65536).find("a grid of 4096 x 4096 tiles and "),
              std::string::npos);
    EXPECT_EQ(message_of(absurd, 512, 512), "no error");
    EXPECT_EQ(message_of({1u << 20, 1, 1, 1.0f, 1.5f, 0.0f}, 65535 * 16, 16), "no error");
    EXPECT_NE(message_of({1u << 20, 1, 1, 1.0f, 1.5f, 0.0f}, 65536 * 16, 16).find("65535 a side"),
              std::string::npos);
}

}  // namespace
}  // namespace kilolux
