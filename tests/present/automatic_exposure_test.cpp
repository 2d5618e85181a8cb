// SPDX-License-Identifier: Apache-2.0
#include "present/image/automatic_exposure.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace kilolux {
namespace {

std::vector<float> grey(const std::vector<float>& luminances) {
    std::vector<float> out;
    for (const float v : luminances) out.insert(out.end(), 3, v);
    return out;
}

TEST(AutomaticExposure, BringsTheLogAverageToMiddleGrey) {
    EXPECT_EQ(automatic_exposure(grey({0.18f, 0.18f})), 0.0f);
    EXPECT_EQ(automatic_exposure(grey({0.045f, 0.045f})), 2.0f);
    EXPECT_EQ(automatic_exposure(grey({0.09f, 0.36f})), 0.0f);
    EXPECT_EQ(automatic_exposure(grey({180.0f})), -9.97f) << "log2(1000), in hundredths";
    // Rec. 709: green alone has 0.7152 of the luminance.
    const std::vector<float> green = {0.0f, 0.18f / 0.7152f, 0.0f};
    EXPECT_EQ(automatic_exposure(green), 0.0f);
}

// A black object with highlights: its log average alone would make all of them white.
TEST(AutomaticExposure, AtMostAFiftiethOfTheLitPixelsClips) {
    std::vector<float> luminances(900, 0.001f);
    luminances.insert(luminances.end(), 82, 0.4f);
    luminances.insert(luminances.end(), 18, 50.0f);
    luminances.insert(luminances.end(), 5000, 0.0f);
    EXPECT_EQ(automatic_exposure(grey(luminances)), 1.32f) << "log2(1 / 0.4), rounded down";
    luminances.insert(luminances.end(), 5, 50.0f);
    EXPECT_EQ(automatic_exposure(grey(luminances)), -5.65f) << "log2(1 / 50): too many to clip";
    // One saturated channel clips as well as three.
    std::vector<float> red;
    for (int i = 0; i < 100; ++i) red.insert(red.end(), {i < 90 ? 0.001f : 0.5f, 0.001f, 0.001f});
    EXPECT_EQ(automatic_exposure(red), 1.0f);
}

TEST(AutomaticExposure, BackgroundAndWhatIsNoNumberDoNotCount) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(automatic_exposure(grey({0.0f, 0.045f, -1.0f, nan, infinity})), 2.0f);
    EXPECT_EQ(automatic_exposure(grey({0.0f, 0.0f})), 0.0f);
    EXPECT_EQ(automatic_exposure({}), 0.0f);
}

}  // namespace
}  // namespace kilolux
