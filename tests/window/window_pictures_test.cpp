// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/window_pictures.h"

#include <gtest/gtest.h>

namespace kilolux {
namespace {

void expect_area(const BoxTarget& area, int x, int width, int height) {
    EXPECT_EQ(area.x, x);
    EXPECT_EQ(area.width, width);
    EXPECT_EQ(area.height, height);
}

TEST(AreaBesideThePanel, IsTheRestOfTheFramebuffer) {
    expect_area(area_beside(0.0f, {800, 600}, {800, 600}), 0, 800, 600);
    expect_area(area_beside(360.0f, {800, 600}, {800, 600}), 360, 440, 600);
    // Two pixels for each window coordinate.
    expect_area(area_beside(360.0f, {800, 600}, {1600, 1200}), 720, 880, 1200);
}

TEST(AreaBesideThePanel, IsEmptyInANarrowOrMinimisedWindow) {
    EXPECT_EQ(area_beside(360.0f, {300, 600}, {300, 600}).width, 0);
    expect_area(area_beside(360.0f, {0, 0}, {0, 0}), 360, 0, 0);
}

}  // namespace
}  // namespace kilolux
