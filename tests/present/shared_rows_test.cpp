// SPDX-License-Identifier: Apache-2.0
#include "present/commands/devices/shared_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <thread>

namespace kilolux {
namespace {

TEST(SharedRows, CoverThePictureOnce) {
    for (const int height : {1, 16, 131, 2160}) {
        for (const int least : {16, 48}) {
            SharedRows rows(height, least, 3, 16);
            int next = 0;
            for (std::size_t device = 0; const auto band = rows.take(device); device = 1 - device) {
                EXPECT_EQ(band->first_row, next);
                EXPECT_GT(band->rows, 0);
                next += band->rows;
                EXPECT_TRUE(next == height || band->rows % least == 0);
                rows.finish(device, *band, 1.0 + static_cast<double>(device));
            }
            EXPECT_EQ(next, height);
        }
    }
}

// Devices take turns by a clock: the device that is done first takes the next rows.
TEST(SharedRows, FastDevicesMakeMoreAndAllEndTogether) {
    constexpr double kMs[] = {0.01, 0.1};  // a row
    SharedRows rows(4000, 16, 2, 16);
    double clock[2] = {0.0, 0.0};
    int made[2] = {0, 0}, bands[2] = {0, 0};
    while (true) {
        const std::size_t device = clock[1] < clock[0] ? 1 : 0;
        const auto band = rows.take(device);
        if (!band) break;
        clock[device] += kMs[device] * band->rows;
        made[device] += band->rows;
        ++bands[device];
        rows.finish(device, *band, kMs[device] * band->rows);
    }
    EXPECT_NEAR(made[0] / 4000.0, 10.0 / 11.0, 0.02);
    EXPECT_LT(std::max(clock[0], clock[1]), 1.1 * 4000 / (1.0 / kMs[0] + 1.0 / kMs[1]));
    EXPECT_GE(std::min(bands[0], bands[1]), 3);
    EXPECT_LE(bands[0] + bands[1], 16);
}

TEST(SharedRows, EqualGpusMakeTheirShareAtOnce) {
    const auto device = [](const char* name, bool is_cpu) {
        DeviceInfo info;
        info.name = name;
        info.is_cpu = is_cpu;
        return info;
    };
    EXPECT_EQ(parts_for({device("a", false), device("a", false)}), 1);
    EXPECT_EQ(parts_for({device("a", false), device("b", false)}), 16);
    EXPECT_EQ(parts_for({device("a", true), device("a", true)}), 16);
    EXPECT_EQ(parts_for({device("a", false), device("a", true)}), 16);
}

TEST(SharedRows, OnePartIsAnEqualShare) {
    SharedRows rows(2160, 16, 2, 1);
    EXPECT_EQ(rows.take(0)->rows, 1088);
    EXPECT_EQ(rows.take(1)->rows, 1072);
}

TEST(SharedRows, ThoseGivenBackAreMadeByOthers) {
    SharedRows rows(32, 32, 2, 16);
    const auto lost = rows.take(0);
    std::optional<Band> found;
    std::jthread other([&] {
        found = rows.take(1);  // waits
        if (found) rows.finish(1, *found, 1.0);
        EXPECT_FALSE(rows.take(1));
    });
    rows.give_back(*lost);
    other.join();
    EXPECT_EQ(found, lost);
    EXPECT_FALSE(rows.take(0));
}

TEST(SharedRows, TakeReturnsNoneAfterAStop) {
    SharedRows rows(32, 16, 2, 16);
    ASSERT_TRUE(rows.take(0) && rows.take(0));
    std::jthread other([&] { EXPECT_FALSE(rows.take(1)); });  // waits
    rows.stop();
    other.join();
}

}  // namespace
}  // namespace kilolux
