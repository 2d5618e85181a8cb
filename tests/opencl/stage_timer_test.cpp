// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/stage_timer.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <thread>

#include "host/gpu/buffer.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

TEST(IdleTime, IsSplitByWhenTheNextCommandWasEnqueued) {
    // Idle from 20 to 50, enqueued at 30; from 60 to 65, enqueued long before.
    const IdleTime found = idle_time({{0, 10, 20}, {5, 65, 70}, {30, 50, 60}}, {});
    EXPECT_EQ(found.enqueue, 10);
    EXPECT_EQ(found.launch, 20 + 5);
}

TEST(IdleTime, IsNoneBetweenCommandsThatTouchOrOverlap) {
    const IdleTime found = idle_time({{0, 10, 20}, {0, 20, 40}, {0, 30, 35}}, {});
    EXPECT_EQ(found.enqueue, 0);
    EXPECT_EQ(found.launch, 0);
}

TEST(IdleTime, BeginsWhereTheLastOfOverlappingCommandsEnds) {
    const IdleTime found = idle_time({{0, 10, 40}, {0, 20, 25}, {45, 50, 60}}, {});
    EXPECT_EQ(found.enqueue, 5);
    EXPECT_EQ(found.launch, 5);
}

// Host spans are not idle time: within a gap, across its ends, beside it, after the enqueue.
TEST(IdleTime, LeavesOutWhatTheHostTellsOf) {
    const std::vector<CommandSpan> commands = {{0, 0, 100}, {200, 250, 300}};
    const auto times = [&](std::vector<HostSpan> host) {
        const IdleTime found = idle_time(commands, host);
        return std::array{found.enqueue, found.launch, found.overlap};
    };
    using Times = std::array<std::int64_t, 3>;
    EXPECT_EQ(times({}), (Times{100, 50, 0}));
    EXPECT_EQ(times({{110, 130}, {150, 160}}), (Times{70, 50, 0}));
    EXPECT_EQ(times({{50, 120}, {190, 240}}), (Times{70, 10, 50}));
    EXPECT_EQ(times({{0, 100}, {210, 300}}), (Times{100, 10, 150}));
    EXPECT_EQ(times({{0, 300}}), (Times{0, 0, 150}));
    EXPECT_EQ(times({{150, 180}, {120, 180}}), (Times{20 + 20, 50, 30}));
    EXPECT_EQ(idle_time({{0, 0, 100}, {0, 40, 90}}, {}).overlap, 50) << "of commands";
}

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

class Timer : public testing::Test {
 protected:
    // A command, `ms` after the last one ended.
    void run_after(double ms) {
        std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(ms));
        cl::Event event;
        gpu_.queue.enqueueFillBuffer(values_.get().buffer(), cl_uint{0}, 0,
                                     kCount * sizeof(cl_uint), nullptr, &event);
        timer_.record("fill", event);
        event.wait();
    }

    static constexpr std::size_t kCount = 1024;
    Gpu gpu_ = test_gpu();
    GrowingArray<uint> values_{gpu_, "fill"};
    StageTimer timer_;

    void SetUp() override { values_.reserve(kCount); }
};

TEST_F(Timer, TellsHowLongTheHostEnqueuedNothing) {
    run_after(0.0);
    run_after(30.0);
    timer_.take();
    EXPECT_GE(timer_.enqueue_ms(), 30.0);
    run_after(30.0);
    timer_.take();
    EXPECT_GE(timer_.enqueue_ms(), 30.0) << "since the last command of the take before";
    EXPECT_TRUE(timer_.take().empty());
    EXPECT_EQ(timer_.enqueue_ms(), 0.0);
}

TEST_F(Timer, TellsWhatTheHostDidBeforeTheFirstAndAfterTheLastCommand) {
    timer_ = StageTimer();
    run_after(30.0);
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    timer_.take();
    EXPECT_GE(timer_.enqueue_ms(), 60.0);
}

TEST_F(Timer, LeavesOutTheHostsOwnRows) {
    constexpr double kSlackMs = 50.0;  // between an enqueue and record()
    const Clock::time_point start = Clock::now();
    run_after(0.0);
    timer_.take();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    timer_.record_host(200.0);
    run_after(0.0);
    const double elapsed = ms_since(start);
    timer_.take();
    EXPECT_LE(timer_.enqueue_ms(), elapsed - 200.0 + kSlackMs);
}

}  // namespace
}  // namespace kilolux
