// SPDX-License-Identifier: Apache-2.0
#include "present/window/overlay/cluster_view.h"

#include <gtest/gtest.h>

namespace kilolux {
namespace {

// The program's form of pixels: column and row without a space between.
TEST(ClusterView, NamesThePixelAsReportsDo) {
    ProbedPixel pixel;
    pixel.x = 59;
    pixel.y = 126;
    EXPECT_EQ(pixel_line(pixel), "59,126  nothing is there");
    pixel.probe.surface.fill(0.0f);
    pixel.probe.surface[SURFACE_DEPTH] = 2.5f;
    EXPECT_EQ(pixel_line(pixel), "59,126  depth 2.50 m");
}

}  // namespace
}  // namespace kilolux
