// SPDX-License-Identifier: Apache-2.0
// Signals end the program with exit code 128 + N, and leave whole files only.
#include <fmt/format.h>
#include <sys/wait.h>

#include <chrono>
#include <random>
#include <thread>

#include "tests/faults/faults.h"

namespace kilolux {
namespace {

// Waits until the program handles the signal, which it blocks for a thread that waits for it
// (proc_pid_status(5)), or has ended.
void wait_until_handled(pid_t child, int number) {
    for (siginfo_t ended = {}; ended.si_pid != child;) {
        const std::string status = text_of_file(fmt::format("/proc/{}/status", child));
        const std::size_t at = status.find("SigBlk:");
        if (at != std::string::npos) {
            const std::uint64_t blocked = std::stoull(status.substr(at + 7), nullptr, 16);
            if ((blocked >> (number - 1) & 1) != 0) return;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOHANG | WNOWAIT);
    }
}

// SIGINT and SIGTERM at any moment from start to end: one in four while libraries are loaded, the
// others after main() has begun to handle them.
TEST_F(Faults, SignalsAtRandomMoments) {
    using Clock = std::chrono::steady_clock;
    const Words words = render_words({}, picture_, {"--quiet"});
    ASSERT_EQ(run_child(words).code, 0) << "builds the kernels";
    Clock::time_point start, handled;
    ASSERT_EQ(run_child(words,
                        [&](pid_t child) {
                            start = Clock::now();
                            wait_until_handled(child, SIGINT);
                            handled = Clock::now();
                        })
                  .code,
              0);
    const Clock::duration loading = handled - start, working = Clock::now() - handled;
    std::mt19937 random(11);
    int interrupted = 0, finished = 0, early = 0;
    for (int i = 0; i < 16; ++i) {
        const int number = i % 2 == 0 ? SIGINT : SIGTERM;
        const bool loads = i % 8 < 2;
        const auto moment = (loads ? loading : working) * static_cast<int>(random() % 1000) / 1000;
        write_text(picture_, kOld);
        const ChildResult result = run_child(words, [&](pid_t child) {
            if (!loads) wait_until_handled(child, number);
            std::this_thread::sleep_for(moment);
            kill(child, number);
        });
        SCOPED_TRACE(fmt::format("signal {} after {} s{}\n{}", number,
                                 std::chrono::duration<double>(moment).count(),
                                 loads ? " of loading" : "", result.err));
        EXPECT_EQ(names_in(folder_), std::set<std::string>{"a.png"});
        if (result.signal != 0) {
            EXPECT_TRUE(loads) << "main() handles signals";
            EXPECT_EQ(result.signal, number);
            EXPECT_EQ(text_of_file(picture_), kOld);
            ++early;
        } else if (result.code == 0) {
            EXPECT_NE(text_of_file(picture_), kOld);
            ++finished;
        } else {
            EXPECT_EQ(result.code, 128 + number);
            EXPECT_EQ(result.err, "kilolux: interrupted\n");
            EXPECT_EQ(text_of_file(picture_), kOld);
            ++interrupted;
        }
    }
    EXPECT_GT(interrupted, 5) << early << " early, " << finished << " finished";
}

// A sequence that is interrupted leaves whole frames only.
TEST_F(Faults, InterruptedSequenceLeavesWholeFrames) {
    const std::string pattern = (elsewhere_ / "f.###.exr").string();
    const ChildResult result =
        run_child(render_words({}, picture_, {"-o", pattern, "--frames", "0:999", "--quiet"}),
                  [&](pid_t child) {
                      while (names_in(elsewhere_).size() < 5) {
                          std::this_thread::sleep_for(std::chrono::milliseconds(20));
                      }
                      kill(child, SIGTERM);
                  });
    EXPECT_EQ(result.code, 143) << result.err;
    std::uintmax_t size = 0;
    for (const std::string& name : names_in(elsewhere_)) {
        EXPECT_TRUE(name.starts_with("f.") && name.ends_with(".exr")) << name;
        EXPECT_GT(fs::file_size(elsewhere_ / name), 500u) << name;
        size += fs::file_size(elsewhere_ / name);
    }
    EXPECT_GT(size, 0u);
}

}  // namespace
}  // namespace kilolux
