// SPDX-License-Identifier: Apache-2.0
// No light is missing from the list of a pixel that it reaches, by float64; lists hold little else,
// and they are the same for every tuning.
#include "host/stages/lists/cull_lights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "tests/opencl/lists/cull_scenarios.h"
#include "tests/support/full.h"
#include "tests/support/slice_search.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

// Lights as the device culls them, in double.
struct ReachTest {
    std::vector<ShadeLight> lights;
    std::vector<double> ranges;

    glm::dvec3 offset(std::size_t i, glm::dvec3 p) const {
        const float4 c = lights[i].position_inv_range2;
        return p - glm::dvec3{c.x, c.y, c.z};
    }
    bool reaches(std::size_t i, glm::dvec3 p) const {
        const glm::dvec3 v = offset(i, p);
        const double d2 = dot(v, v);
        if (d2 >= ranges[i] * ranges[i]) return false;
        const float4 axis = lights[i].axis_cos;
        if (axis.w <= -1.0f) return true;
        return dot(v, glm::dvec3{axis.x, axis.y, axis.z}) > axis.w * std::sqrt(d2);
    }
};

ReachTest reach_test_of(const Gpu& gpu, const CullCase& c, const PreparedLights& prepared) {
    ReachTest test{download<ShadeLight>(gpu, prepared.lights, c.lights.size()), {}};
    for (const Light& light : c.lights) test.ranges.push_back(light.position_range.w);
    return test;
}

struct Pairs {
    std::size_t tested = 0, reaching = 0;
};

Pairs expect_none_missing(const CullCase& c, const ReachTest& test, const HostLists& lists) {
    Pairs pairs;
    const View& view = c.planes.view;
    std::map<const ActiveCluster*, std::vector<uint>> pixels_of;
    for (const uint pixel : c.pixels) {
        const uint x = pixel % view.width;
        const uint y = pixel / view.width;
        const uint slice = slice_by_search(fine_grid(c.grid), c.planes.at(SURFACE_DEPTH, x, y));
        const ActiveCluster* cluster = lists.find(fine_tile_of(view, x, y), slice);
        if (cluster == nullptr) {
            ADD_FAILURE() << "pixel " << x << ", " << y << " has no active cluster";
            return pairs;
        }
        pixels_of[cluster].push_back(pixel);
    }
    for (const auto& [cluster, pixels] : pixels_of) {
        std::vector<bool> listed(c.lights.size(), false);
        for (const uint light : lists.refined_of(*cluster)) listed[light] = true;
        for (const uint pixel : pixels) {
            const glm::dvec3 p =
                c.planes.vector(SURFACE_POSITION, pixel % view.width, pixel / view.width);
            for (std::size_t light = 0; light < c.lights.size(); ++light) {
                if (!test.reaches(light, p)) continue;
                ++pairs.reaching;
                if (listed[light]) continue;
                ADD_FAILURE() << "light " << light << " (range " << test.ranges[light]
                              << ", distance " << length(test.offset(light, p))
                              << ") is missing at pixel " << pixel % view.width << ", "
                              << pixel / view.width;
                return pairs;
            }
        }
        pairs.tested += pixels.size() * c.lights.size();
    }
    return pairs;
}

double interval_distance(double c, double lo, double hi) { return std::max({lo - c, c - hi, 0.0}); }

// Every listed light reaches the box of the pixels, but for rounding.
void expect_no_idlers(const CullCase& c, const ReachTest& test, const HostLists& lists) {
    for (const ActiveCluster& box : lists.clusters) {
        const auto list = lists.refined_of(box);
        ASSERT_TRUE(std::is_sorted(list.begin(), list.end(), std::less_equal<>()) ||
                    list.size() < 2);
        for (const uint light : list) {
            ASSERT_LT(light, c.lights.size());
            const float4 p = test.lights[light].position_inv_range2;
            const glm::dvec3 d{interval_distance(p.x, box.min_x, box.max_x),
                               interval_distance(p.y, box.min_y, box.max_y),
                               interval_distance(p.z, box.min_z, box.max_z)};
            ASSERT_LE(length(d), test.ranges[light] * 1.000002) << "light " << light;
        }
    }
}

// The walk's lists equal the brute-force kernel's, entry by entry.
void expect_as_brute_force(const Gpu& gpu, const CullCase& c, const ListedLights& device,
                           const HostLists& lists) {
    CullLights oracle(gpu, default_tuning(gpu.info), c.features);
    StageTimer timer;
    const CoarseLists brute = oracle.brute_force(device.lights, device.boxes, timer);
    const auto offsets = download<uint>(gpu, brute.offsets, std::size_t{c.grid.cluster_count} + 1);
    const auto entries =
        download_indices(gpu, brute.lists, c.features.light_index_bits, offsets.back());
    for (uint cluster = 0; cluster < c.grid.cluster_count; ++cluster) {
        const std::span expected(entries.data() + offsets[cluster],
                                 offsets[cluster + 1] - offsets[cluster]);
        const auto found = lists.coarse_of(cluster);
        ASSERT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end()))
            << "cluster " << cluster;
    }
}

TEST(CullLights, NoLightIsMissingByFloat64AndFewAreListedInVain) {
    Gpu gpu = test_gpu();
    Pairs sum;
    for (const CullScenario& scenario : cull_scenarios()) {
        SCOPED_TRACE(scenario.name);
        const CullCase c = make_cull_case(gpu, scenario);
        const ListedLights device =
            list_everywhere(gpu, default_tuning(gpu.info), c.features,
                            {c.gbuffer, upload_lights(gpu, c.lights), c.grid});
        const HostLists lists = download_lists(gpu, c.features, device);
        const ReachTest test = reach_test_of(gpu, c, device.lights);
        const Pairs pairs = expect_none_missing(c, test, lists);
        expect_no_idlers(c, test, lists);
        expect_as_brute_force(gpu, c, device, lists);
        // Most lights are made to reach something, though not to reach the only pixel of a small
        // image.
        EXPECT_GT(pairs.reaching, c.lights.size() / 4);
        sum.tested += pairs.tested;
        sum.reaching += pairs.reaching;
        if (HasFatalFailure()) return;
    }
    RecordProperty("pairs_tested", std::to_string(sum.tested));
    RecordProperty("pairs_reaching", std::to_string(sum.reaching));
    EXPECT_GT(sum.tested, 10'000'000u);
    EXPECT_GT(sum.reaching, 1'000'000u);
}

void expect_lists_of_occupied_clusters(const Tuning& tuning) {
    const Gpu gpu = test_gpu();
    std::uint64_t left_out = 0, kept = 0;
    for (const CullScenario& scenario : cull_scenarios()) {
        SCOPED_TRACE(scenario.name);
        const CullCase c = make_cull_case(gpu, scenario);
        ListedLights device = list_everywhere(gpu, default_tuning(gpu.info), c.features,
                                              {c.gbuffer, upload_lights(gpu, c.lights), c.grid});
        const HostLists all = download_lists(gpu, c.features, device);
        const auto occupied =
            download<std::uint8_t>(gpu, device.clusters.occupied, c.grid.cluster_count);
        CullLights cull(gpu, tuning, c.features);
        StageTimer timer;
        do {
            device.coarse =
                cull.enqueue(device.lights, device.boxes, timer, device.clusters.occupied);
        } while (!cull.fits());
        const HostLists some = download_lists(gpu, c.features, device);
        for (uint cluster = 0; cluster < c.grid.cluster_count; ++cluster) {
            const auto expected = all.coarse_of(cluster);
            const auto found = some.coarse_of(cluster);
            const bool wanted = occupied[cluster] != 0;
            ASSERT_EQ(found.size(), wanted ? expected.size() : 0u) << "cluster " << cluster;
            ASSERT_TRUE(std::equal(found.begin(), found.end(), expected.begin()))
                << "cluster " << cluster;
            (wanted ? kept : left_out) += expected.size();
        }
    }
    EXPECT_GT(left_out, 1000u);
    EXPECT_GT(kept, 1000u);
}

TEST(CullLights, ListsOfOccupiedClustersAreThoseOfAllAndOthersAreEmpty) {
    Tuning tuning = default_tuning(test_gpu().info);
    for (const int group : {1, 32}) {
        SCOPED_TRACE(group);
        tuning.cull_group = group;
        expect_lists_of_occupied_clusters(tuning);
    }
}

std::string lists_of(const Gpu& gpu, const CullCase& c, const Tuning& tuning) {
    const ListedLights device =
        list_everywhere(gpu, tuning, c.features, {c.gbuffer, upload_lights(gpu, c.lights), c.grid});
    return fingerprint(download_lists(gpu, c.features, device));
}

std::vector<Tuning> cull_tunings(const DeviceInfo& info) {
    std::vector<Tuning> all(6, default_tuning(info));
    all[1].cull_chunks = 1;
    all[2].cull_chunks = 7;
    all[2].cull_group = 4;
    all[3].cull_chunks = 1000;
    all[3].refine_group = 64;
    all[4].refine_group = 3;
    all[4].tile_group = 64;
    all[4].light_group = 64;
    all[5].cull_group = 64;
    all[5].prefix_group = 64;
    all[5].prefix_per_item = 3;
    return all;
}

TEST(CullLights, ListsAreTheSameForEveryTuningLaneWidthAndRun) {
    const auto scenarios = cull_scenarios();
    const auto scenario = std::find_if(scenarios.begin(), scenarios.end(),
                                       [](const CullScenario& s) { return s.name == "spots"; });
    const CullCase c = make_cull_case(test_gpu(), *scenario);
    const std::string expected = lists_of(test_gpu(), c, default_tuning(test_gpu().info));
    for (int run = 0; run < 5; ++run) {
        ASSERT_TRUE(lists_of(test_gpu(), c, default_tuning(test_gpu().info)) == expected)
            << "run " << run;
    }
    int index = 0;
    for (const Tuning& tuning : cull_tunings(test_gpu().info)) {
        ASSERT_TRUE(lists_of(test_gpu(), c, tuning) == expected) << "tuning " << index;
        ++index;
    }
    for (const int lanes : lane_widths()) {
        const Gpu gpu = test_gpu(lanes);
        ASSERT_TRUE(lists_of(gpu, c, default_tuning(gpu.info)) == expected) << "lanes " << lanes;
    }
}

void expect_all_listed(uint count, const Tuning& tuning) {
    const Gpu gpu = test_gpu();
    KernelFeatures features;
    features.light_index_bits = count <= 65536 ? 16 : 32;
    const View view = make_view(ViewShape{1, 1});
    const ClusterGrid grid = make_cluster_grid({}, 1, 1);
    const GBuffer gbuffer =
        upload_gbuffer(gpu, make_synthetic(view, features, noise_depth(2.0, 3.0, 0, 1)));
    const std::vector<Light> lights(count, point_light({}, 100.0));
    const HostLists lists = download_lists(
        gpu, features,
        list_everywhere(gpu, tuning, features, {gbuffer, upload_lights(gpu, lights), grid}));
    ASSERT_EQ(lists.clusters.size(), 1u);
    const auto list = lists.refined_of(lists.clusters.front());
    std::vector<uint> expected(count);
    std::iota(expected.begin(), expected.end(), 0u);
    EXPECT_TRUE(std::equal(list.begin(), list.end(), expected.begin(), expected.end()))
        << count << " lights, listed " << list.size() << ": " << (list.empty() ? 0 : list.front())
        << " to " << (list.empty() ? 0 : list.back());
}

TEST(CullLights, HoldsAnyNumberOfLightsInOneCluster) {
    Tuning groups = default_tuning(test_gpu().info);
    groups.cull_group = 64;
    for (const uint count :
         {0u, 1u, 2u, 63u, 64u, 65u, 4095u, 4096u, 4097u, 65535u, 65536u, 65537u, 100000u}) {
        expect_all_listed(count, default_tuning(test_gpu().info));
        expect_all_listed(count, groups);
    }
    groups.cull_group = 4;
    expect_all_listed(300000, groups);  // more segments than work-items
}

// Lists by groups are those of brute force, whatever the order of the lights: of every size at
// random, which groups cannot skip; along rays, of which they skip most.
void expect_no_light_skipped(uint count, std::initializer_list<int> groups) {
    const Gpu gpu = test_gpu();
    const auto scenarios = cull_scenarios();
    CullScenario scenario = *std::ranges::find(scenarios, "smooth", &CullScenario::name);
    scenario.light_count = count;
    CullCase c = make_cull_case(gpu, scenario);
    c.features.light_index_bits = count <= 65536 ? 16 : 32;
    const auto expect_all = [&] {
        for (const int group : groups) {
            SCOPED_TRACE(group);
            Tuning tuning = default_tuning(gpu.info);
            tuning.cull_group = group;
            const ListedLights device = list_everywhere(
                gpu, tuning, c.features, {c.gbuffer, upload_lights(gpu, c.lights), c.grid});
            expect_as_brute_force(gpu, c, device, download_lists(gpu, c.features, device));
        }
    };
    expect_all();
    for (std::size_t i = 0; i < c.lights.size(); ++i) {
        // Runs of 50 lights lie along a ray; the last block of each span lies elsewhere.
        const auto run = static_cast<double>(i / 50);
        const double depth = 1.0 + static_cast<double>(i % 50);
        const double side = i % 2048 < 2016 ? 0.3 : -0.3;
        const double x = side * (0.6 + 0.3 * std::sin(0.02 * run)), y = side * std::cos(0.03 * run);
        const glm::dvec3 place{x * depth, y * depth, -depth};
        c.lights[i] = point_light(world_from_view(c.gbuffer.view, place), 0.05 * depth);
    }
    expect_all();
}

TEST(CullLights, GroupsSkipNoLightThatReachesACluster) {
    expect_no_light_skipped(20'000, {1, 32, 64, 256});
}

// More spans than work-items of a group.
TEST(CullLights, GroupsSkipNoSpanThatReachesACluster) { expect_no_light_skipped(140'000, {4}); }

// With room for fewer tasks a segment has several spans, also of different numbers.
TEST(CullLights, ListsAreTheSameForAnyRoomOfTasks) {
    const Gpu gpu = test_gpu();
    const View view = make_view(ViewShape{});
    const ClusterGrid grid = make_cluster_grid({16, 9, 8, 0.1f, 100.0f, 0.0f}, 64, 48);
    std::vector<Light> lights;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> side(-1.0, 1.0);
    constexpr int kLights = 11000;  // six spans, from near to far
    for (int i = 0; i < kLights; ++i) {
        const double depth = 0.1 + 60.0 * i / kLights;
        lights.push_back(point_light(
            world_from_view(view, {side(random) * depth, side(random) * depth, -depth}), 1.5));
    }
    StageTimer timer;
    PrepareLights prepare(gpu, default_tuning(gpu.info));
    BuildClusters build(gpu);
    const PreparedLights prepared = prepare.enqueue(upload_lights(gpu, lights), view, grid, timer);
    const ClusterBoxes boxes = build.enqueue(view, grid, timer);
    const auto lists_of_room = [&](int group, std::size_t tasks) {
        Tuning tuning = default_tuning(gpu.info);
        tuning.cull_group = group;
        CullLights cull(gpu, tuning, {}, tasks * grid.cluster_count);
        const CoarseLists lists = cull.enqueue(prepared, boxes, timer);
        EXPECT_TRUE(cull.fits());
        return std::pair(download<uint>(gpu, lists.offsets, grid.cluster_count + 1),
                         download<std::uint16_t>(gpu, lists.lists, cull.pairs()));
    };
    const auto expected = lists_of_room(1, 0);
    EXPECT_GT(expected.second.size(), lights.size());
    for (const std::size_t tasks : {0u, 1u, 2u, 4u, 5u, 6u, 100u}) {
        EXPECT_EQ(lists_of_room(32, tasks), expected) << tasks << " tasks a cluster";
    }
}

TEST(CullLights, LacksRoomOnceThenGrows) {
    const Gpu gpu = test_gpu();
    const View view = make_view(ViewShape{});
    const ClusterGrid grid = make_cluster_grid({16, 9, 8, 0.1f, 100.0f, 0.0f}, 64, 48);
    const std::vector<Light> lights(3000, point_light({}, 1e6));
    PrepareLights prepare(gpu, default_tuning(gpu.info));
    BuildClusters build(gpu);
    CullLights cull(gpu, default_tuning(gpu.info), {});
    StageTimer timer;
    const PreparedLights prepared = prepare.enqueue(upload_lights(gpu, lights), view, grid, timer);
    const ClusterBoxes boxes = build.enqueue(view, grid, timer);
    const CoarseLists first = cull.enqueue(prepared, boxes, timer);
    ASSERT_GT(std::size_t{grid.cluster_count} * lights.size(), first.capacity)
        << "the case does not overflow";
    EXPECT_EQ(cull.pairs(), std::size_t{grid.cluster_count} * lights.size());
    EXPECT_FALSE(cull.fits());
    const CoarseLists second = cull.enqueue(prepared, boxes, timer);
    EXPECT_TRUE(cull.fits());
    const auto entries = download<std::uint16_t>(gpu, second.lists, cull.pairs());
    for (std::size_t i = 0; i < entries.size(); ++i) ASSERT_EQ(entries[i], i % lights.size());
}

}  // namespace
}  // namespace kilolux
