// SPDX-License-Identifier: Apache-2.0
// Active clusters against a map from (tile, slice) to pixels.
#include "host/stages/lists/bin_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "host/certify/synthetic/host_lists.h"
#include "host/certify/synthetic/synthetic.h"
#include "tests/support/full.h"
#include "tests/support/slice_search.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

struct Box {
    float min_x = 1e38f, min_y = 1e38f, min_z = 1e38f;
    float max_x = -1e38f, max_y = -1e38f, max_z = -1e38f;
    uint pixels = 0;
};

using BoxMap = std::map<std::pair<uint, uint>, Box>;  // by (tile, slice)

// The box holds the pixels' stored positions exactly, so decode's planes are the reference here;
// their accuracy is tested with decode_gbuffer.
BoxMap expected_boxes(const ClusterGrid& grid, const Planes& planes) {
    BoxMap boxes;
    const View& view = planes.view;
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.width; ++x) {
            // Background decodes to no normal.
            const glm::dvec3 normal = planes.vector(SURFACE_NORMAL, x, y);
            if (dot(normal, normal) == 0.0) continue;
            const uint slice = slice_by_search(fine_grid(grid), planes.at(SURFACE_DEPTH, x, y));
            Box& box = boxes[{fine_tile_of(view, x, y), slice}];
            const float px = planes.at(SURFACE_POSITION, x, y);
            const float py = planes.at(SURFACE_POSITION + 1, x, y);
            const float pz = planes.at(SURFACE_POSITION + 2, x, y);
            box.min_x = std::min(box.min_x, px);
            box.min_y = std::min(box.min_y, py);
            box.min_z = std::min(box.min_z, pz);
            box.max_x = std::max(box.max_x, px);
            box.max_y = std::max(box.max_y, py);
            box.max_z = std::max(box.max_z, pz);
            ++box.pixels;
        }
    }
    return boxes;
}

bool same_box(const ActiveCluster& c, const Box& b) {
    return c.min_x == b.min_x && c.min_y == b.min_y && c.min_z == b.min_z && c.max_x == b.max_x &&
           c.max_y == b.max_y && c.max_z == b.max_z;
}

void expect_clusters(const Gpu& gpu, const ActiveClusters& found, const BoxMap& expected) {
    const auto offsets = download<uint>(gpu, found.offsets, std::size_t{found.tile_count} + 1);
    ASSERT_EQ(offsets.back(), expected.size());
    ASSERT_LE(offsets.back(), found.capacity);
    const auto clusters = download<ActiveCluster>(gpu, found.clusters, offsets.back());
    auto next = expected.begin();
    for (uint tile = 0; tile < found.tile_count; ++tile) {
        for (uint i = offsets[tile]; i < offsets[tile + 1]; ++i, ++next) {
            ASSERT_EQ(std::pair(tile, clusters[i].slice), next->first) << "cluster " << i;
            ASSERT_EQ(clusters[i].pixel_count, next->second.pixels) << "tile " << tile;
            ASSERT_TRUE(same_box(clusters[i], next->second)) << "box of tile " << tile;
        }
    }
}

// Coarse clusters with an active one, and no others.
void expect_occupied(const Gpu& gpu, const ActiveClusters& found, const ClusterGrid& grid,
                     const View& view, const BoxMap& boxes) {
    std::vector<std::uint8_t> expected(grid.cluster_count, 0);
    const uint fine_tiles_x = view.stride / FINE_TILE;
    for (const auto& [key, box] : boxes) {
        const auto [tile, slice] = key;
        const uint x = tile % fine_tiles_x * FINE_TILE;
        const uint y = tile / fine_tiles_x * FINE_TILE + view.first_row;
        expected[cluster_index(grid, x / grid.tile_width, y / grid.tile_height,
                               slice >> grid.fine_slice_bits)] = 1;
    }
    EXPECT_EQ(download<std::uint8_t>(gpu, found.occupied, grid.cluster_count), expected);
}

// Each tile's pixels once, cluster by cluster in ascending order, then background pixels.
void expect_order(const Gpu& gpu, const ActiveClusters& found, const ClusterGrid& grid,
                  const Planes& planes) {
    const View& view = planes.view;
    const auto offsets = download<uint>(gpu, found.offsets, std::size_t{found.tile_count} + 1);
    const auto order =
        download<std::uint8_t>(gpu, found.order, std::size_t{found.tile_count} * FINE_TILE_PIXELS);
    const uint tiles_x = view.stride / FINE_TILE;
    constexpr uint kNoCluster = 0xffffffffu;
    for (uint tile = 0; tile < found.tile_count; ++tile) {
        if (offsets[tile] == offsets[tile + 1]) continue;
        const uint first_y = tile / tiles_x * FINE_TILE;
        const uint count = std::min<uint>(FINE_TILE, view.height - first_y) * FINE_TILE;
        std::vector<std::pair<uint, uint>> expected;  // (slice, code), sorted
        std::vector<std::pair<uint, uint>> got;
        for (uint code = 0; code < FINE_TILE_PIXELS; ++code) {
            const auto key = [&](uint pixel) {
                const uint x = tile % tiles_x * FINE_TILE + pixel % FINE_TILE;
                const uint y = first_y + pixel / FINE_TILE;
                if (x >= view.width || y >= view.height) return std::pair(kNoCluster, pixel);
                const glm::dvec3 normal = planes.vector(SURFACE_NORMAL, x, y);
                if (dot(normal, normal) == 0.0) return std::pair(kNoCluster, pixel);
                const float z = planes.at(SURFACE_DEPTH, x, y);
                return std::pair(slice_by_search(fine_grid(grid), z), pixel);
            };
            if (code >= count) break;
            expected.push_back(key(code));
            got.push_back(key(order[tile * FINE_TILE_PIXELS + code]));
        }
        std::sort(expected.begin(), expected.end());
        ASSERT_EQ(got, expected) << "tile " << tile;
    }
}

struct Case {
    const char* name;
    uint width, height;
    DepthOf depth;
    int lanes = 0;
    int tile_group = 1;
    uint layout = GBUFFER_PACKED;
    bool orthographic = false;
    uint first_row = 0;  // of a band
};

void expect_case(const Case& c) {
    SCOPED_TRACE(std::string(c.name) + " " + std::to_string(c.width) + "x" +
                 std::to_string(c.height) + ", lanes " + std::to_string(c.lanes));
    const Gpu gpu = test_gpu(c.lanes);
    KernelFeatures features;
    features.gbuffer = c.layout;
    ViewShape shape;
    shape.width = c.width;
    shape.height = c.height;
    shape.orthographic = c.orthographic;
    View view = make_view(shape);
    view.first_row = c.first_row;
    const ClusterGrid grid =
        make_cluster_grid({16, 9, 4, 0.5f, 50.0f, 0.0f}, view.width, view.height + view.first_row);
    const GBuffer gbuffer = upload_gbuffer(gpu, make_synthetic(view, features, c.depth));
    Tuning tuning = default_tuning(gpu.info);
    tuning.tile_group = c.tile_group;
    BinPixels stage(gpu, tuning, features);
    StageTimer timer;
    ActiveClusters found = stage.enqueue(gbuffer, grid, timer);
    if (!stage.fits()) found = stage.enqueue(gbuffer, grid, timer);
    ASSERT_TRUE(stage.fits());
    const Planes planes = decode(gpu, features, gbuffer);
    const BoxMap boxes = expected_boxes(grid, planes);
    expect_clusters(gpu, found, boxes);
    expect_occupied(gpu, found, grid, view, boxes);
    expect_order(gpu, found, grid, planes);
}

// From in front of slice 0 to beyond the last, 30 % background.
DepthOf wide_noise() { return noise_depth(0.2, 90.0, 0.3, 11); }

TEST(BinPixels, AgreesWithAMapOfPixelsAtEverySize) {
    for (const auto& [width, height] :
         {std::pair{1u, 1u}, {17u, 31u}, {16u, 16u}, {33u, 17u}, {8192u, 1u}, {1u, 300u}}) {
        expect_case({"noise", width, height, wide_noise()});
        expect_case({"slanted", width, height, slanted_depth(0.3, 60.0, width)});
    }
    expect_case({"slanted", 1919, 1079, slanted_depth(0.3, 60.0, 1919)});
}

TEST(BinPixels, AgreesAtLaneWidthsAndGroupSizes) {
    for (const int lanes : lane_widths()) {
        for (const int group : {1, 7, 64, 256})
            expect_case({"noise", 70, 45, wide_noise(), lanes, group});
    }
}

// One work-item a tile, and a group of them.
constexpr int kGroups[] = {1, 64};

TEST(BinPixels, AgreesOnDepthDiscontinuities) {
    for (const int group : kGroups) {
        expect_case({"checkerboard", 97, 65, checkerboard_depth(0.6, 40.0), 0, group});
        expect_case({"all slices", 64, 64, noise_depth(0.4, 60.0, 0.0, 3), 0, group});
        expect_case({"orthographic", 97, 65, noise_depth(-5.0, 80.0, 0.2, 3), 0, group,
                     GBUFFER_PACKED, true});
    }
}

// So many clusters in each tile, and background.
DepthOf clusters_and_background(uint count) {
    return [=](uint x, uint y) {
        const uint i = (y % FINE_TILE * FINE_TILE + x % FINE_TILE) % (count + 1);
        return i == count ? no_depth()(x, y) : 0.55 * std::exp2(6.0 * i / count);
    };
}

// A group fills 32 at once, background among them.
TEST(BinPixels, AgreesOnTilesThatFillSeveralTimes) {
    for (const uint count : {31u, 32u, 63u, 64u})
        expect_case({"many clusters", 33, 33, clusters_and_background(count), 0, 64});
}

TEST(BinPixels, AgreesOnLayoutsThatStorePositions) {
    for (const int group : kGroups) {
        expect_case({"full", 49, 35, wide_noise(), 0, group, GBUFFER_FULL});
        expect_case({"half", 49, 35, wide_noise(), 0, group, GBUFFER_HALF});
    }
}

TEST(BinPixels, AgreesInABandOfThePicture) {
    for (const int group : kGroups)
        expect_case({"band", 97, 65, wide_noise(), 0, group, GBUFFER_PACKED, false, 128});
}

TEST(BinPixels, BackgroundHasNoClusters) {
    for (const int group : kGroups) {
        expect_case({"background", 1, 1, no_depth(), 0, group});
        expect_case({"background", 333, 77, no_depth(), 0, group});
    }
}

TEST(BinPixels, LacksRoomOnceThenGrows) {
    const Gpu gpu = test_gpu();
    const View view = make_view(ViewShape{});
    const GBuffer gbuffer =
        upload_gbuffer(gpu, make_synthetic(view, {}, noise_depth(0.3, 80.0, 0.0, 5)));
    const ClusterGrid grid = make_cluster_grid({16, 9, 64, 0.5f, 50.0f, 0.0f}, 64, 48);
    BinPixels stage(gpu, default_tuning(gpu.info), {});
    StageTimer timer;
    const ActiveClusters first = stage.enqueue(gbuffer, grid, timer);
    ASSERT_GT(stage.active(), first.capacity) << "the case does not overflow";
    const auto cut = download<ActiveCluster>(gpu, first.clusters, first.capacity);
    EXPECT_FALSE(stage.fits());
    const ActiveClusters second = stage.enqueue(gbuffer, grid, timer);
    EXPECT_TRUE(stage.fits());
    const auto whole = download<ActiveCluster>(gpu, second.clusters, first.capacity);
    EXPECT_EQ(std::memcmp(cut.data(), whole.data(), cut.size() * sizeof(ActiveCluster)), 0);
    expect_clusters(gpu, second, expected_boxes(grid, decode(gpu, {}, gbuffer)));
}

}  // namespace
}  // namespace kilolux
