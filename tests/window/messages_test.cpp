// SPDX-License-Identifier: Apache-2.0
#include "present/window/overlay/messages.h"

#include <gtest/gtest.h>

namespace kilolux {
namespace {

TEST(Messages, ANoticeFadesAndEnds) {
    Messages messages;
    messages.show("wrote a.png", 10.0);
    EXPECT_FALSE(messages.update("", 12.0));
    EXPECT_EQ(messages.notice().alpha(), 1.0f);
    EXPECT_TRUE(messages.update("", 15.5));
    EXPECT_NEAR(messages.notice().alpha(), 0.5f, 1e-6f);
    EXPECT_FALSE(messages.update("", 15.5)) << "nothing to draw anew";
    EXPECT_TRUE(messages.update("", 16.0));
    EXPECT_EQ(messages.notice().text(), "");
    EXPECT_FALSE(messages.update("", 20.0));
}

TEST(Messages, TheNewestNoticeIsShown) {
    Messages messages;
    messages.show("first", 0.0);
    messages.update("", 5.9);
    messages.show("second", 6.0);
    EXPECT_TRUE(messages.update("", 6.0)) << "in full again";
    EXPECT_EQ(messages.notice().text(), "second");
    EXPECT_EQ(messages.notice().alpha(), 1.0f);
}

TEST(Messages, AnotherLineOfAWaitIsDrawn) {
    Messages messages;
    EXPECT_FALSE(messages.update("", 0.0));
    EXPECT_TRUE(messages.update("1 s", 1.0));
    EXPECT_EQ(messages.waiting(), "1 s");
    EXPECT_FALSE(messages.update("1 s", 1.5));
    EXPECT_TRUE(messages.update("2 s", 2.0));
    EXPECT_TRUE(messages.update("", 2.5));
    EXPECT_EQ(messages.waiting(), "");
}

}  // namespace
}  // namespace kilolux
