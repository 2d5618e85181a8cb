// SPDX-License-Identifier: Apache-2.0
#include "host/base/suggest.h"

#include <gtest/gtest.h>

namespace kilolux {
namespace {

const std::vector<std::string> kWords = {"--lights", "--light-seed", "--light-radius", "--lanes",
                                         "--stats"};

TEST(Suggest, FindsOneSlip) {
    EXPECT_EQ(nearest_word("--ligths", kWords), "--lights");   // swapped
    EXPECT_EQ(nearest_word("--light", kWords), "--lights");    // left out
    EXPECT_EQ(nearest_word("--lightss", kWords), "--lights");  // doubled
    EXPECT_EQ(nearest_word("--lamts", kWords), "--lanes");
    EXPECT_EQ(nearest_word("--stets", kWords), "--stats");
    EXPECT_EQ(nearest_word("--light-sed", kWords), "--light-seed");
}

TEST(Suggest, SaysNothingWhenNothingIsNear) {
    EXPECT_EQ(nearest_word("--wireframe", kWords), "");
    EXPECT_EQ(nearest_word("3", {"1", "2", "4"}), "");
    EXPECT_EQ(nearest_word("", kWords), "");
    EXPECT_EQ(nearest_word("x", {}), "");
    EXPECT_EQ(did_you_mean("--wireframe", kWords), "");
    EXPECT_EQ(did_you_mean("--ligths", kWords), "; did you mean '--lights'?");
}

TEST(Suggest, Joins) {
    EXPECT_EQ(joined({}), "");
    EXPECT_EQ(joined({"a"}), "a");
    EXPECT_EQ(joined({"a", "b", "c"}, "|"), "a|b|c");
}

TEST(Text, LowerSplitAndTrim) {
    EXPECT_EQ(lower("A.PnG\xc4"), "a.png\xc4");
    EXPECT_EQ(split("a,,b", ','), (std::vector<std::string_view>{"a", "", "b"}));
    EXPECT_EQ(split("", ','), (std::vector<std::string_view>{""}));
    EXPECT_EQ(split("a,", ','), (std::vector<std::string_view>{"a", ""}));
    EXPECT_EQ(trim(" \t a b\r\n"), "a b");
    EXPECT_EQ(trim(" \n"), "");
}

}  // namespace
}  // namespace kilolux
