// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <limits>
#include <set>
#include <vector>

#include "host/base/error.h"
#include "present/cli/sequence.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

TEST(Sequence, FrameNames) {
    EXPECT_EQ(numbered_file("frame.####.exr", 7), "frame.0007.exr");
    EXPECT_EQ(numbered_file("frame.####.exr", 12345), "frame.12345.exr");
    EXPECT_EQ(numbered_file("f#.png", 7), "f7.png");
    EXPECT_EQ(numbered_file("#", 0), "0");
    EXPECT_EQ(numbered_file("##a###.png", 3), "##a003.png");  // the last run
    EXPECT_EQ(numbered_file("out#1/frame.##.exr", 3), "out#1/frame.03.exr");
    EXPECT_EQ(numbered_file("plain.exr", 3), "plain.exr");
    EXPECT_EQ(numbered_file("", 3), "");
    EXPECT_TRUE(has_frame_pattern("a/b.##.exr"));
    EXPECT_FALSE(has_frame_pattern("a##/b.exr"));
}

std::vector<int> all(const ShardNumbers& frames) {
    std::vector<int> out;
    for (std::size_t i = 0; i < frames.size(); ++i) out.push_back(frames[i]);
    return out;
}

TEST(Sequence, ShardsPartTheFrames) {
    EXPECT_EQ(all({FrameRange{5, 12}, {1, 3}}), (std::vector{6, 9, 12}));
    EXPECT_EQ(all({FrameRange{0, 3}, {0, 1}}), (std::vector{0, 1, 2, 3}));
    EXPECT_EQ(all({FrameRange{9, 9}, {0, 4}}), (std::vector{9}));
    EXPECT_EQ(all({FrameRange{9, 9}, {1, 4}}), (std::vector<int>{}));
    const int end = std::numeric_limits<int>::max();
    EXPECT_EQ(all({FrameRange{end - 2, end}, {1, 2}}), (std::vector{end - 1}));
    const ShardNumbers every(FrameRange{0, end}, {0, 1});
    EXPECT_EQ(every.size(), std::size_t{1} << 31);
    EXPECT_EQ(every[every.size() - 1], end);
}

TEST(Sequence, ListsOfRangesAscend) {
    const FrameList list({{1, 9, 4}, {10, 10}, {20, 22, 2}});
    EXPECT_EQ(all({list, {}}), (std::vector{1, 5, 9, 10, 20, 22}));
    EXPECT_EQ(all({list, {1, 4}}), (std::vector{5, 22}));
    EXPECT_EQ(list.first(), 1);
    EXPECT_EQ(list.last(), 22);
    EXPECT_EQ(message_of<Error>([] { FrameList({{1, 9}, {9, 12}}); }), "frame 9 comes after 9");
}

TEST(Sequence, EveryFrameIsInOneShard) {
    for (int count = 1; count <= 9; ++count) {
        std::multiset<int> seen;
        for (int index = 0; index < count; ++index) {
            for (const int frame : all({FrameRange{7, 31}, {index, count}})) {
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
