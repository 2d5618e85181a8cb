// SPDX-License-Identifier: Apache-2.0
// Texts of sweeps on the command line, and the points that they mean.
#include "host/measure/bench/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "host/base/error.h"

namespace kilolux {
namespace {

using Counts = std::vector<std::uint64_t>;

Counts parse(const std::string& text) {
    return parse_count_sweep("--lights", text, 0, std::uint64_t{1} << 31);
}

TEST(Sweep, ParsesNumbersRangesAndFactors) {
    const struct {
        const char* text;
        Counts values;
    } cases[] = {
        {"500", {500}},
        {"0", {0}},
        {"500,1000,200", {500, 1000, 200}},
        {"500:2000:500", {500, 1000, 1500, 2000}},
        {"1:6:2", {1, 3, 5}},
        {"7:7:1", {7}},
        {"256:8192:*2", {256, 512, 1024, 2048, 4096, 8192}},
        {"1:100:*10,5,10", {1, 10, 100, 5}},
        {"3:100:*5", {3, 15, 75}},
        {"2147483648", {2147483648u}},
        {"20k,1e6", {20000, 1000000}},
        {"1k:3k:1k", {1000, 2000, 3000}},
        {"0:2147483648:2147483648", {0, 2147483648u}},
    };
    for (const auto& c : cases) EXPECT_EQ(parse(c.text), c.values) << c.text;
}

TEST(Sweep, RefusesWhatIsNone) {
    for (const char* text : {"",           ",",
                             "5,",         "a",
                             "-5",         "5:1:1",
                             "1:5",        "1:5:0",
                             "1:5:*1",     "1:5:*0",
                             "0:5:*2",     "1:5:",
                             "1:5:2:3",    "1.5",
                             "1:5:*",      " 5",
                             "2147483649", "99999999999999999999999",
                             "1:30000:1",  "18446744073709551615"}) {
        EXPECT_THROW(parse(text), UsageError) << "'" << text << "'";
    }
    try {
        parse_count_sweep("--lights", "1:9:4", 2, 8);
        ADD_FAILURE() << "1 and 9 are out of range";
    } catch (const UsageError& error) {
        EXPECT_STREQ(error.what(), "--lights: '1:9:4' has 1, must be from 2 to 8");
    }
    // The largest numbers do not wrap around.
    const auto most = ~std::uint64_t{0};
    EXPECT_EQ(parse_count_sweep("--n", "18446744073709551614:18446744073709551615:2", 0, most),
              (Counts{most - 1}));
    EXPECT_EQ(parse_count_sweep("--n", "9223372036854775808:18446744073709551615:*2", 0, most),
              (Counts{most / 2 + 1}));
}

TEST(Sweep, MakesEveryCombinationOnce) {
    SweepAxes axes;
    axes.renderers = {RendererKind::deferred, RendererKind::deferred_all};
    axes.lights = {10, 20, 30};
    axes.grids = {{4, 4, 1}, {16, 9, 4}};
    axes.lanes = {1, 16};
    const auto points = sweep_points(axes);
    // All-lights shading has no grid: only the first.
    EXPECT_EQ(points.size(), 3u * 2u * 2u + 3u * 2u);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(std::count(points.begin(), points.end(), points[i]), 1) << i;
        if (!has_clusters(points[i].renderer)) {
            EXPECT_EQ(points[i].grid, axes.grids[0]) << i;
        }
    }
    EXPECT_EQ(varying_fields(points),
              (std::vector<std::string>{"renderer", "lights", "grid", "lanes"}));
    EXPECT_EQ(sweep_points(SweepAxes{}), std::vector<SweepPoint>{SweepPoint{}});
    EXPECT_TRUE(varying_fields(std::vector{SweepPoint{}}).empty());
    EXPECT_TRUE(varying_fields(std::vector<SweepPoint>{}).empty());
}

TEST(Sweep, PutsAPointIntoSettings) {
    const SweepPoint point{RendererKind::deferred_all, {64, 36}, 7, {3, 2, 8}, 4, GBUFFER_HALF};
    RenderSettings base;
    base.ambient = 0.5f;
    base.grid.fine_per_octave = 64;
    const RenderSettings settings = settings_at(base, point);
    EXPECT_EQ(settings.renderer, RendererKind::deferred_all);
    EXPECT_EQ(settings.width, 64);
    EXPECT_EQ(settings.height, 36);
    EXPECT_EQ(settings.lights.count, 7u);
    EXPECT_EQ(settings.grid.tiles_x, 3);
    EXPECT_EQ(settings.grid.tiles_y, 2);
    EXPECT_EQ(settings.grid.slices_per_octave, 8);
    EXPECT_EQ(settings.kernels.lanes, 4);
    EXPECT_EQ(settings.gbuffer, static_cast<uint>(GBUFFER_HALF));
    EXPECT_EQ(settings.ambient, 0.5f) << "what the point does not say stays";
    EXPECT_EQ(settings.grid.fine_per_octave, 64);
}

TEST(Sweep, NamesRenderersBothWays) {
    for (const RendererKind renderer : {RendererKind::deferred, RendererKind::forward_plus,
                                        RendererKind::forward, RendererKind::deferred_all}) {
        EXPECT_EQ(renderer_of_name(renderer_name(renderer)), renderer);
    }
    EXPECT_THROW(renderer_of_name("backward"), Error);
}

TEST(Sweep, ExplainsAGridThatIsNotWhatItSays) {
    SweepPoint point;
    EXPECT_EQ(grid_explanation(point, {0, 0, 0}), "") << "no clusters";
    EXPECT_EQ(grid_explanation(point, {15, 9, 33}),
              "grid 16,9,4 of 1920x1080 pixels is 15x9x33 clusters: tile edges are multiples of 16 "
              "pixels, and the depth has 33 slices at 4 for each doubling");
}

}  // namespace
}  // namespace kilolux
