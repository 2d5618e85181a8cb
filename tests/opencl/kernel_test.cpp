// SPDX-License-Identifier: Apache-2.0
// Work-groups that a device allows a kernel.
#include "host/gpu/kernel.h"

#include <gtest/gtest.h>

#include "host/base/error.h"

namespace kilolux {
namespace {

TEST(FitGroups, FreeOnesGetSmallerAndKeepTheirItems) {
    for (const std::size_t largest : {1, 3, 64, 255, 256, 1024}) {
        const WorkSize size = fit_groups(items(1000, 256), largest, "stage");
        ASSERT_EQ(size.global.get()[0], 1024u);
        EXPECT_LE(size.local.get()[0], largest);
        EXPECT_GT(2 * size.local.get()[0], std::min<std::size_t>(largest, 256));
        EXPECT_EQ(1024 % size.local.get()[0], 0u);
    }
}

// PoCL ends the program where it chooses groups for such a device.
TEST(FitGroups, NoneAreLeftToTheDriverOfADeviceOfSmallOnes) {
    const WorkSize size{cl::NDRange(32, 5, 3), cl::NullRange};
    for (const std::size_t largest : {1, 4, 8}) {
        const WorkSize fitting = fit_groups(size, largest, "stage");
        ASSERT_EQ(fitting.local.dimensions(), 3u);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(fitting.local.get()[i], 1u);
        EXPECT_EQ(fitting.global.get()[2], 3u);
    }
    EXPECT_EQ(fit_groups(size, 256, "stage").local.dimensions(), 0u);
}

TEST(FitGroups, FixedOnesAreRefusedWithBothSizes) {
    EXPECT_EQ(fit_groups(groups(3, 64), 64, "stage").local.get()[0], 64u);
    try {
        fit_groups(groups(3, 256), 64, "stage");
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(),
                     "stage: groups of 256 work-items; the device allows this kernel groups of 64");
    }
}

}  // namespace
}  // namespace kilolux
