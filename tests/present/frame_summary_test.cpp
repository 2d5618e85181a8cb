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
    const auto text = [&] { return frame_summary(Scene{}, {}, record, 1); };
    EXPECT_TRUE(contains(text(), "\nlights  5 of 5 used, 0 rejected\n")) << text();
    stats.directional_lights = 4;
    stats.evaluations_per_pixel = 0.5;
    EXPECT_TRUE(contains(text(), "used, 0 rejected; 0.5 evaluated a pixel, 0.0 useful\n"))
        << text();
}

}  // namespace
}  // namespace kilolux
