// SPDX-License-Identifier: Apache-2.0
#include "present/cli/frame_summary.h"

#include <gtest/gtest.h>

#include "tests/support/messages.h"

namespace kilolux {
namespace {

TEST(FrameSummary, LightsOfNoListAreNotEvaluatedZeroTimes) {
    FrameRecord record;
    record.file = "a.png";
    FrameStats& stats = record.stats;
    stats.lights_given = stats.lights_used = stats.directional_lights = 5;
    stats.evaluations_per_pixel = stats.useful_evaluations_per_pixel = 0.0;
    const auto text = [&] { return frame_summary(record, {}); };
    EXPECT_TRUE(text().starts_with("lights  5 of 5 used, 0 rejected\n")) << text();
    const auto evaluations = [&] { return stats_json({}, {}, record)["evaluations"]["per_pixel"]; };
    EXPECT_TRUE(evaluations().is_null());
    stats.directional_lights = 4;
    stats.evaluations_per_pixel = 0.5;
    EXPECT_TRUE(contains(text(), "used, 0 rejected; 0.5 evaluated a pixel, 0.0 useful\n"))
        << text();
    EXPECT_EQ(evaluations(), 0.5);
}

TEST(FrameSummary, HasARowAGroupOrAStage) {
    FrameRecord record;
    record.file = "a.png";
    record.stats.stages = {{"bin_triangles", 1.0}, {"raster_triangles", 2.0}, {"launch", 0.5}};
    record.stats.frame_ms = 4.0;
    const std::string groups = frame_summary(record, {.build_seconds = 0.9});
    EXPECT_TRUE(contains(groups, "\n  surfaces              3.00 ms\n")) << groups;
    EXPECT_TRUE(contains(groups, "\n  host                  1.00 ms\n")) << "launch and other";
    EXPECT_FALSE(contains(groups, "raster_triangles")) << groups;
    EXPECT_FALSE(contains(groups, "kernels")) << groups;
    const std::string stages = frame_summary(record, {.build_seconds = 8.7, .by_stage = true});
    EXPECT_TRUE(contains(stages, "\n  raster_triangles      2.00 ms\n")) << stages;
    EXPECT_TRUE(contains(stages, "\n  other                 0.50 ms\n")) << stages;
    EXPECT_TRUE(contains(stages, "\nkernels built in 8.7 s;")) << stages;
}

}  // namespace
}  // namespace kilolux
