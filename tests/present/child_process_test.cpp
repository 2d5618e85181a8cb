// SPDX-License-Identifier: Apache-2.0
#include "host/base/system/child_process.h"

#include <gtest/gtest.h>

#include <csignal>

namespace kilolux {
namespace {

TEST(ChildProcess, SaysHowItEnded) {
    ChildProcess good({"true"}), bad({"false"});
    EXPECT_TRUE(good.succeeded());
    EXPECT_FALSE(bad.succeeded());
    EXPECT_EQ(bad.ending(), "exit code 1");
}

TEST(ChildProcess, WhoseEndIsNotKnownHasNotSucceeded) {
    const auto former = std::signal(SIGCHLD, SIG_IGN);  // the system then keeps no status
    ChildProcess bad({"false"});
    EXPECT_FALSE(bad.succeeded());
    EXPECT_NE(bad.ending().find("SIGCHLD is ignored"), std::string::npos) << bad.ending();
    std::signal(SIGCHLD, former);
}

}  // namespace
}  // namespace kilolux
