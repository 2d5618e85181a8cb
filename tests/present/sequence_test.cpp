// SPDX-License-Identifier: Apache-2.0
#include "present/cli/sequence.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace kilolux {
namespace {

TEST(Sequence, FrameNames) {
    EXPECT_EQ(frame_file("frame.####.exr", 7), "frame.0007.exr");
    EXPECT_EQ(frame_file("frame.####.exr", 12345), "frame.12345.exr");
    EXPECT_EQ(frame_file("f#.png", 7), "f7.png");
    EXPECT_EQ(frame_file("#", 0), "0");
    EXPECT_EQ(frame_file("##a###.png", 3), "##a003.png");  // the last run
    EXPECT_EQ(frame_file("out#1/frame.##.exr", 3), "out#1/frame.03.exr");
    EXPECT_EQ(frame_file("plain.exr", 3), "plain.exr");
    EXPECT_EQ(frame_file("", 3), "");
    EXPECT_TRUE(has_frame_pattern("a/b.##.exr"));
    EXPECT_FALSE(has_frame_pattern("a##/b.exr"));
}

TEST(Sequence, ShardsPartTheFrames) {
    EXPECT_EQ(frames_of_shard({5, 12}, {1, 3}), (std::vector{6, 9, 12}));
    EXPECT_EQ(frames_of_shard({0, 3}, {0, 1}), (std::vector{0, 1, 2, 3}));
    EXPECT_EQ(frames_of_shard({9, 9}, {0, 4}), (std::vector{9}));
    EXPECT_TRUE(frames_of_shard({9, 9}, {1, 4}).empty());
    const int end = std::numeric_limits<int>::max();
    EXPECT_EQ(frames_of_shard({end - 2, end}, {1, 2}), (std::vector{end - 1}));
}

TEST(Sequence, EveryFrameIsInOneShard) {
    for (int count = 1; count <= 9; ++count) {
        std::multiset<int> seen;
        for (int index = 0; index < count; ++index) {
            for (const int frame : frames_of_shard({7, 31}, {index, count})) {
                EXPECT_EQ((frame - 7) % count, index) << "frame " << frame << " of " << count;
                seen.insert(frame);
            }
        }
        ASSERT_EQ(seen.size(), 25u) << count << " shards";
        for (int frame = 7; frame <= 31; ++frame) EXPECT_EQ(seen.count(frame), 1u) << frame;
    }
}

}  // namespace
}  // namespace kilolux
