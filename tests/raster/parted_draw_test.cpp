// SPDX-License-Identifier: Apache-2.0
// The parts of a watched pass: what is drawn, and what its watch hears of.
#include "raster/parted_draw.h"

#include <limits>
#include <thread>

#include "host/base/error.h"
#include "tests/raster/gl_fixture.h"

namespace kilolux {
namespace {

using PartedDrawTest = GlTest;

constexpr double kUnknown = std::numeric_limits<double>::infinity();

struct Part {
    int first = 0, rows = 0;
};

// Draws as a thread of the window does; a part takes at least `time`.
std::vector<Part> parts_of(int height, std::chrono::milliseconds time = {},
                           double expected_s = kUnknown) {
    const WorkWatch watch([](double) {});
    std::vector<Part> parts;
    draw_in_parts(7, height, {expected_s}, [&] {
        int box[4];
        glGetIntegerv(GL_SCISSOR_BOX, box);
        EXPECT_EQ(box[0], 0);
        EXPECT_EQ(box[2], 7);
        parts.push_back({box[1], box[3]});
        std::this_thread::sleep_for(time);
    });
    EXPECT_FALSE(glIsEnabled(GL_SCISSOR_TEST));
    return parts;
}

TEST_F(PartedDrawTest, EveryRowIsDrawnOnceAndTheFirstPartOfEachPassIsSmall) {
    for (int pass = 0; pass < 50; ++pass) {
        for (const int height : {1, 4, 330, 3000}) {
            const std::vector<Part> parts = parts_of(height);
            ASSERT_LE(parts[0].rows, 4) << "pass " << pass;
            int next = 0;
            for (const Part& part : parts) {
                ASSERT_EQ(part.first, next) << "pass " << pass;
                ASSERT_GT(part.rows, 0) << "pass " << pass;
                next += part.rows;
            }
            EXPECT_GE(next, height);
        }
    }
}

TEST_F(PartedDrawTest, SlowPartsStaySmall) {
    const std::vector<Part> parts = parts_of(24, std::chrono::milliseconds(150));
    EXPECT_EQ(parts.size(), 6u);
}

TEST_F(PartedDrawTest, APassIsDividedByWhatItTookBefore) {
    EXPECT_EQ(parts_of(24, {}, 0.2).at(0).rows, 12);
    EXPECT_EQ(parts_of(24, {}, 1e6).at(0).rows, 4);
    const WorkWatch watch([](double) { FAIL() << "a short pass is one part"; });
    int drawn = 0;
    draw_in_parts(7, 24, {0.09}, [&] {
        ++drawn;
        EXPECT_FALSE(glIsEnabled(GL_SCISSOR_TEST));
    });
    EXPECT_EQ(drawn, 1);
}

TEST_F(PartedDrawTest, RowsThatAreSlowAreDrawnByColumns) {
    const WorkWatch watch([](double) {});
    constexpr int kPartedWidth = 100, kPartedHeight = 10;
    std::vector<int> drawn(static_cast<std::size_t>(kPartedWidth) * 12);
    int first = 0;
    draw_in_parts(kPartedWidth, kPartedHeight, {kUnknown, 64.0}, [&] {
        int box[4];
        glGetIntegerv(GL_SCISSOR_BOX, box);
        if (first == 0) first = box[2] * box[3];
        for (int y = box[1]; y < box[1] + box[3]; ++y) {
            for (int x = box[0]; x < box[0] + box[2]; ++x) {
                ++drawn.at(static_cast<std::size_t>(y * kPartedWidth + x));
            }
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(60));
    });
    EXPECT_EQ(first, 64);
    for (std::size_t i = 0; i < static_cast<std::size_t>(kPartedWidth) * kPartedHeight; ++i) {
        ASSERT_EQ(drawn[i], 1) << i;
    }
}

TEST_F(PartedDrawTest, TheWatchHearsTheShareAndCanGiveUp) {
    std::vector<double> shares;
    const WorkWatch watch([&](double share) {
        shares.push_back(share);
        if (share >= 0.5) throw Interrupted();
    });
    int drawn = 0;
    const auto slow = [&] {
        ++drawn;
        std::this_thread::sleep_for(std::chrono::milliseconds(110));
    };
    EXPECT_THROW(draw_in_parts(7, 16, {}, slow), Interrupted);
    glDisable(GL_SCISSOR_TEST);
    EXPECT_EQ(drawn, 2);
    EXPECT_EQ(shares, (std::vector<double>{0.0, 0.25, 0.5}));
}

TEST_F(PartedDrawTest, NobodyWatchesAWholePass) {
    int drawn = 0;
    draw_in_parts(7, 330, {}, [&] {
        ++drawn;
        EXPECT_FALSE(glIsEnabled(GL_SCISSOR_TEST));
    });
    EXPECT_EQ(drawn, 1);
}

}  // namespace
}  // namespace kilolux
