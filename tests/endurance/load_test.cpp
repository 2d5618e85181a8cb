// SPDX-License-Identifier: Apache-2.0
// Many programs at once on few cores.
#include <gtest/gtest.h>

#include <future>

#include "tests/support/child.h"

namespace kilolux {
namespace {

TEST(Load, TwentyFourProcessesAtOnceAllFinishRight) {
    constexpr int kProcesses = 24;
    const TemporaryFolder folder;
    const auto file = [&](int i) { return folder / (std::to_string(i) + ".png"); };
    const auto start = [&](int i) {
        return std::async(std::launch::async, [&file, i] {
            return run_kilolux({"render", "plain", "--lights", "100", "--resolution", "64,48",
                                "--quiet", "-o", file(i).string()});
        });
    };
    std::vector<std::future<ChildResult>> running;
    for (int i = 0; i < kProcesses; ++i) running.push_back(start(i));
    for (std::future<ChildResult>& one : running) {
        const ChildResult result = one.get();
        EXPECT_EQ(result.code, 0) << "signal " << result.signal << " " << result.err;
        EXPECT_EQ(result.err, "");
    }
    const std::string first = text_of_file(file(0));
    EXPECT_GT(first.size(), 500u);
    for (int i = 1; i < kProcesses; ++i) EXPECT_EQ(text_of_file(file(i)), first) << i;
    EXPECT_EQ(names_in(folder).size(), std::size_t{kProcesses});
}

}  // namespace
}  // namespace kilolux
