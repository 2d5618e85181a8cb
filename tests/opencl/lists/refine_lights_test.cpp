// SPDX-License-Identifier: Apache-2.0
// Refined lists: the coarse list of each active cluster, without the lights that do not reach its
// pixels' box. cull_lights_test.cpp tests that none is missing.
#include "host/stages/lists/refine_lights.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "host/certify/synthetic/host_lists.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

const GridRequest kRefinedRequest{2, 2, 1, 0.5f, 50.0f, 0.0f};

double box_distance(const ActiveCluster& c, float4 p) {
    const auto axis = [](double v, double lo, double hi) {
        return std::max({lo - v, v - hi, 0.0});
    };
    return length(glm::dvec3{axis(p.x, c.min_x, c.max_x), axis(p.y, c.min_y, c.max_y),
                             axis(p.z, c.min_z, c.max_z)});
}

uint coarse_cluster(const View& view, const ClusterGrid& grid, uint tile, uint slice) {
    const uint tiles_x = fine_tiles_x(view);
    return cluster_index(grid, tile % tiles_x * FINE_TILE / grid.tile_width,
                         tile / tiles_x * FINE_TILE / grid.tile_height,
                         slice >> grid.fine_slice_bits);
}

// A list in double: lights nearer to the box than their range, where rounding does not decide.
void expect_list(const ActiveCluster& box, std::span<const uint> found,
                 std::span<const uint> coarse, const std::vector<float4>& bounds,
                 const std::vector<Light>& lights) {
    std::size_t next = 0;
    for (const uint light : coarse) {
        const double ratio = box_distance(box, bounds[light]) / lights[light].position_range.w;
        const bool listed = next < found.size() && found[next] == light;
        if (listed) ++next;
        if (ratio < 1) {
            ASSERT_TRUE(listed) << "light " << light << " is missing";
        }
        if (ratio > 1 + 2e-6) {
            ASSERT_FALSE(listed) << "light " << light << " is listed in vain";
        }
    }
    ASSERT_EQ(next, found.size()) << "not a part of the coarse list in its order";
}

void expect_refined(const Gpu& gpu, const Tuning& tuning, std::uint32_t light_count,
                    int index_bits) {
    KernelFeatures features;
    features.light_index_bits = index_bits;
    const View view = make_view(ViewShape{97, 65});
    const ClusterGrid grid = make_cluster_grid(kRefinedRequest, view.width, view.height);
    RandomLightOptions mix;
    mix.count = light_count;
    const std::vector<Light> lights = random_lights(view, mix);
    const GBuffer gbuffer =
        upload_gbuffer(gpu, make_synthetic(view, {}, slanted_depth(0.4, 60.0, 97)));
    const ListedLights device =
        list_everywhere(gpu, tuning, features, {gbuffer, upload_lights(gpu, lights), grid});
    const HostLists lists = download_lists(gpu, features, device);
    const auto bounds = download<float4>(gpu, device.lights.bounds, lights.size());
    for (uint tile = 0; tile + 1 < lists.cluster_offsets.size(); ++tile) {
        for (uint i = lists.cluster_offsets[tile]; i < lists.cluster_offsets[tile + 1]; ++i) {
            const ActiveCluster& box = lists.clusters[i];
            expect_list(box, lists.refined_of(box),
                        lists.coarse_of(coarse_cluster(view, grid, tile, box.slice)), bounds,
                        lights);
            if (testing::Test::HasFatalFailure()) return;
        }
    }
}

TEST(RefineLights, AgreesWithDoubleForAnyCountAndGroup) {
    const Gpu gpu = test_gpu();
    for (const int group : {1, 3, 64}) {
        for (const std::uint32_t count : {0u, 1u, 7u, 8u, 9u, 511u, 512u, 513u, 2500u}) {
            for (const int bits : {16, 32}) {  // 32: by blocks
                SCOPED_TRACE("group " + std::to_string(group) + ", " + std::to_string(count) +
                             " lights, indices of " + std::to_string(bits) + " bits");
                Tuning tuning = default_tuning(gpu.info);
                tuning.refine_group = group;
                expect_refined(gpu, tuning, count, bits);
            }
        }
    }
}

TEST(RefineLights, LacksRoomOnceThenGrows) {
    const Gpu gpu = test_gpu();
    const Tuning tuning = default_tuning(gpu.info);
    const View view = make_view(ViewShape{});
    const ClusterGrid grid =
        make_cluster_grid({1, 1, 1, 0.5f, 0.5f, 0.0f}, view.width, view.height);
    // 12 tiles of one cluster each: more entries than the first room of 2^20.
    const std::vector<Light> lights(100000, point_light({}, 1e6));
    KernelFeatures features;
    features.light_index_bits = 32;
    const GBuffer gbuffer =
        upload_gbuffer(gpu, make_synthetic(view, features, slanted_depth(1, 2, 64)));
    ListedLights device =
        list_everywhere(gpu, tuning, features, {gbuffer, upload_lights(gpu, lights), grid});
    RefineLights refine(gpu, tuning, features);
    StageTimer timer;
    device.refined = refine.enqueue(device.lights, device.coarse, device.clusters, view, timer);
    ASSERT_LT(device.refined.capacity, 12u * lights.size()) << "the case does not overflow";
    HostLists cut = download_lists(gpu, features, device);
    for (const ActiveCluster& c : cut.clusters)
        EXPECT_LE(c.list_begin + c.list_count, device.refined.capacity);
    EXPECT_FALSE(refine.fits());
    device.refined = refine.enqueue(device.lights, device.coarse, device.clusters, view, timer);
    EXPECT_TRUE(refine.fits());
    const HostLists lists = download_lists(gpu, features, device);
    ASSERT_EQ(lists.clusters.size(), 12u);
    for (const ActiveCluster& c : lists.clusters) {
        const auto list = lists.refined_of(c);
        ASSERT_EQ(list.size(), lights.size());
        for (uint i = 0; i < list.size(); ++i) ASSERT_EQ(list[i], i);
    }
}

TEST(RefineLights, SpotsThatShineAwayAreLeftOut) {
    const Gpu gpu = test_gpu();
    ViewShape shape;
    shape.rotated = false;
    const View view = make_view(shape);
    const ClusterGrid grid = make_cluster_grid(kRefinedRequest, view.width, view.height);
    KernelFeatures features;
    features.spot_lights = true;
    const GBuffer gbuffer =
        upload_gbuffer(gpu, make_synthetic(view, features, slanted_depth(9, 9.5, 64)));
    const Light point = point_light({0, 0, -5}, 100);
    const std::vector<Light> lights = {spot_light(point, {0, 0, 1}, 0.2, 0.3),
                                       spot_light(point, {0, 0, -1}, 0.2, 1.5),
                                       spot_light(point, {0, 1, 0}, 0.2, 0.3), point};
    const HostLists lists =
        download_lists(gpu, features,
                       list_everywhere(gpu, default_tuning(gpu.info), features,
                                       {gbuffer, upload_lights(gpu, lights), grid}));
    ASSERT_FALSE(lists.clusters.empty());
    for (const ActiveCluster& c : lists.clusters) {
        const auto list = lists.refined_of(c);
        EXPECT_EQ(std::vector<uint>(list.begin(), list.end()), (std::vector<uint>{1, 3}));
    }
}

// Flat lights shine into a half-space: no cluster whose box is behind it lists them.
TEST(RefineLights, HalfSpacesAreTestedByTheCornersOfBoxes) {
    const Gpu gpu = test_gpu();
    const View view = make_view(square_pixels(97, 65));
    const ClusterGrid grid = make_cluster_grid(kRefinedRequest, view.width, view.height);
    KernelFeatures features;
    features.spot_lights = true;
    const GBuffer gbuffer =
        upload_gbuffer(gpu, make_synthetic(view, features, noise_depth(0.5, 40.0, 0.0, 3)));
    Random random(5);
    std::vector<Light> lights;
    for (int i = 0; i < 200; ++i) {
        const Light point = point_light(world_from_view(view, random.point(30.0)), 1000.0);
        lights.push_back(spot_light(point, random.direction(), 1.0, 1.5707963267948966));
    }
    const ListedLights made = list_everywhere(gpu, default_tuning(gpu.info), features,
                                              {gbuffer, upload_lights(gpu, lights), grid});
    const HostLists lists = download_lists(gpu, features, made);
    const auto rows = download<ShadeLight>(gpu, made.lights.lights, lights.size());
    std::size_t behind = 0;
    for (const ActiveCluster& c : lists.clusters) {
        const auto list = lists.refined_of(c);
        for (uint i = 0; i < rows.size(); ++i) {
            const float4 &p = rows[i].position_inv_range2, &axis = rows[i].axis_cos;
            const auto most = [](double a, double lo, double hi) {
                return std::max(a * lo, a * hi);
            };
            const double corner = most(axis.x, double{c.min_x} - p.x, double{c.max_x} - p.x) +
                                  most(axis.y, double{c.min_y} - p.y, double{c.max_y} - p.y) +
                                  most(axis.z, double{c.min_z} - p.z, double{c.max_z} - p.z);
            const bool listed = std::ranges::find(list, i) != list.end();
            const double margin = 1e-3 * (1.0 + std::abs(corner));
            if (std::abs(corner) < margin) continue;
            EXPECT_EQ(listed, corner > 0.0) << "light " << i << ", corner " << corner;
            behind += corner < 0.0 ? 1 : 0;
        }
    }
    EXPECT_GT(behind, 1000u);
}

// Half angles above 90 degrees: light goes backwards, too.
TEST(RefineLights, WideSpotsReachWhatLiesBehindThem) {
    const Gpu gpu = test_gpu();
    ViewShape shape;
    shape.rotated = false;
    const View view = make_view(shape);
    const ClusterGrid grid = make_cluster_grid(kRefinedRequest, view.width, view.height);
    KernelFeatures features;
    features.spot_lights = true;
    const GBuffer gbuffer =
        upload_gbuffer(gpu, make_synthetic(view, features, slanted_depth(9, 9.5, 64)));
    const Light point = point_light({0, 0, -5}, 100);
    const std::vector<Light> lights = {
        spot_light(point, {0, 0, 1}, 0.2, 3.1),   // dark only straight ahead of the camera
        spot_light(point, {0, 1, 0}, 0.2, 2.8),   // surfaces are 40 to 140 degrees off its axis
        spot_light(point, {0, 0, 1}, 0.2, 1.7)};  // surfaces are more than 120 degrees off
    const HostLists lists =
        download_lists(gpu, features,
                       list_everywhere(gpu, default_tuning(gpu.info), features,
                                       {gbuffer, upload_lights(gpu, lights), grid}));
    ASSERT_FALSE(lists.clusters.empty());
    std::size_t wide = 0;
    for (const ActiveCluster& c : lists.clusters) {
        const auto list = lists.refined_of(c);
        wide += std::ranges::find(list, 0u) != list.end() ? 1 : 0;
        EXPECT_NE(std::ranges::find(list, 1u), list.end());
        EXPECT_EQ(std::ranges::find(list, 2u), list.end());
    }
    EXPECT_GT(wide, lists.clusters.size() / 2);
}

// Two active clusters of one tile whose coarse lists together have 2^32 entries and some.
TEST(RefineLights, MoreTestsInATileThan32BitsCountAreAnError) {
    const Gpu gpu = test_gpu();
    const View view = make_view(ViewShape{16, 16});
    ClusterGrid grid = make_cluster_grid({1, 1, 1, 1.0f, 3.0f, 0.0f, 1}, 16, 16);
    ASSERT_EQ(grid.cluster_count, 2u);
    std::vector<ActiveCluster> active(2);
    active[1].slice = 1;
    // The second list ends where 32 bits wrap: offsets do not ascend.
    const std::vector<uint> offsets{0, 0xffffffffu, 15};
    ActiveClusters clusters;
    clusters.grid = grid;
    clusters.offsets = new_buffer(gpu, std::vector<uint>{0, 2});
    clusters.clusters = new_buffer(gpu, active);
    clusters.capacity = 2;
    clusters.tile_count = 1;
    const CoarseLists coarse{
        new_buffer(gpu, offsets), new_buffer(gpu, std::vector<uint>(4)), 0, {}};
    PreparedLights lights;
    lights.lights = new_buffer(gpu, std::vector<ShadeLight>(1));
    lights.bounds = new_buffer(gpu, std::vector<float4>(1));
    RefineLights stage(gpu, default_tuning(gpu.info), {});
    StageTimer timer;
    stage.enqueue(lights, coarse, clusters, view, timer);
    EXPECT_EQ(stage.tests(), 0xffffffffu) << "saturates";
    EXPECT_THROW(stage.fits(), Error);
}

}  // namespace
}  // namespace kilolux
