// SPDX-License-Identifier: Apache-2.0
#include "present/window/panel/stage_history.h"

#include <gtest/gtest.h>

namespace kilolux {
namespace {

FrameStats stats_of(double shade_ms) {
    FrameStats stats;
    stats.stages = {{"shade", shade_ms}};
    stats.frame_ms = shade_ms + 1.0;
    return stats;
}

// A median must not mix pictures of two renderers: beside the limit of one of them it would exceed
// 100 %.
TEST(StageHistory, MediansAreOverPicturesOfTheNewestOnesSettings) {
    StageHistory history;
    for (int i = 0; i < 9; ++i) history.add(stats_of(2.0), i > 0);
    EXPECT_EQ(history.median_ms(0), 2.0);
    EXPECT_EQ(history.median_frame_ms(), 3.0);
    history.add(stats_of(40.0), false);
    EXPECT_EQ(history.median_ms(0), 40.0);
    EXPECT_EQ(history.median_frame_ms(), 41.0);
    history.add(stats_of(60.0), true);
    history.add(stats_of(50.0), true);
    EXPECT_EQ(history.median_ms(0), 50.0);
}

}  // namespace
}  // namespace kilolux
