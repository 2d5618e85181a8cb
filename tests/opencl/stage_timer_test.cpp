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
    using Times = std::array<std::int64_t, 2>;
    const auto times = [&](const std::vector<HostSpan>& host) {
        const IdleTime found = idle_time(commands, host);
        return Times{found.enqueue, found.launch};
    };
    EXPECT_EQ(times({}), (Times{100, 50}));
    EXPECT_EQ(times({{110, 130}, {150, 160}}), (Times{70, 50}));
    EXPECT_EQ(times({{50, 120}, {190, 240}}), (Times{70, 10}));
    EXPECT_EQ(times({{0, 100}, {210, 400}}), (Times{100, 10}));
    EXPECT_EQ(times({{0, 400}}), (Times{0, 0}));
    EXPECT_EQ(times({{150, 180}, {120, 180}}), (Times{40, 50})) << "spans that overlap";
}

// No moment has two rows: host spans, commands and idle time add up to the whole.
TEST(IdleTime, GivesTheHostWhatTheDeviceIdled) {
    const std::vector<CommandSpan> commands = {{0, 0, 100}, {200, 250, 300}};
    using Parts = std::vector<std::int64_t>;
    const auto parts = [&](const std::vector<HostSpan>& host) {
        const IdleTime found = idle_time(commands, host);
        std::int64_t sum = found.enqueue + found.launch;
        for (const std::int64_t part : found.host) sum += part;
        EXPECT_EQ(sum, 150);
        return found.host;
    };
    EXPECT_EQ(parts({{10, 90}, {260, 300}}), (Parts{0, 0})) << "beside the device";
    EXPECT_EQ(parts({{190, 260}, {50, 120}}), (Parts{60, 20})) << "in the order given";
    EXPECT_EQ(parts({{0, 400}}), (Parts{150}));
    EXPECT_EQ(parts({{150, 180}, {120, 190}, {130, 240}}), (Parts{0, 70, 50}));
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

// A frame drops commands that it repeats. What the host did meanwhile keeps its row, and is no idle
// time.
TEST_F(Timer, KeepsTheHostsTimeWhereCommandsAreDropped) {
    run_after(0.0);
    timer_.take();
    const StageTimer before = timer_;
    const Clock::time_point start = Clock::now();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    timer_.record_host("host", 200.0);
    run_after(0.0);
    timer_.drop_commands_since(before);
    run_after(0.0);
    const double elapsed = ms_since(start);
    const std::vector<StageTimer::Time> times = timer_.take();
    ASSERT_EQ(times.size(), 2u);
    EXPECT_EQ(times[0].stage, "host");
    EXPECT_NEAR(times[0].ms, 200.0, 50.0);
    EXPECT_LE(timer_.enqueue_ms() + timer_.launch_ms(), elapsed - 200.0 + 50.0);
}

TEST_F(Timer, LeavesOutTheHostsOwnRows) {
    constexpr double kSlackMs = 50.0;  // between an enqueue and record()
    const Clock::time_point start = Clock::now();
    run_after(0.0);
    timer_.take();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    timer_.record_host("host", 200.0);
    run_after(0.0);
    const double elapsed = ms_since(start);
    timer_.take();
    EXPECT_LE(timer_.enqueue_ms(), elapsed - 200.0 + kSlackMs);
}

// The host works while the device does, as where OpenGL draws: the time counts once.
TEST_F(Timer, CountsOnceWhatTheHostDidBesideTheDevice) {
    constexpr std::size_t kLarge = std::size_t{1} << 24;
    values_.reserve(kLarge);
    run_after(0.0);
    const Clock::time_point start = Clock::now();
    timer_.take();
    for (int i = 0; i < 8; ++i) {
        cl::Event event;
        gpu_.queue.enqueueFillBuffer(values_.get().buffer(), cl_uint{0}, 0,
                                     kLarge * sizeof(cl_uint), nullptr, &event);
        timer_.record("fill", event);
    }
    gpu_.queue.finish();
    timer_.record_host("host", ms_since(start));
    const std::vector<StageTimer::Time> times = timer_.take();
    const double elapsed = ms_since(start);
    ASSERT_EQ(times.size(), 2u);
    EXPECT_EQ(times[1].stage, "fill");
    const double idle = timer_.enqueue_ms() + timer_.launch_ms();
    EXPECT_LT(times[0].ms + times[1].ms + idle, elapsed + 0.5 * times[1].ms);
}

// A program that is built, and what a driver does before a kernel's first launch, is no idle time.
TEST_F(Timer, LeavesOutWhatIsBuilt) {
    constexpr double kSlackMs = 50.0;  // between an enqueue and record()
    run_after(0.0);
    timer_.take();
    const Clock::time_point start = Clock::now();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    timer_.record_build(start, Clock::now());
    run_after(0.0);
    const double elapsed = ms_since(start);
    timer_.take();
    EXPECT_GE(timer_.build_ms(), 200.0);
    EXPECT_LE(timer_.build_ms(), elapsed);
    EXPECT_LE(timer_.enqueue_ms(), elapsed - 200.0 + kSlackMs);
    run_after(0.0);
    timer_.take();
    EXPECT_EQ(timer_.build_ms(), 0.0) << "of the time before";
}

// A user event holds the command back, as a compiler does.
TEST_F(Timer, LeavesOutWhatComesBeforeAFirstLaunch) {
    run_after(0.0);
    timer_.take();
    for (const bool is_first : {false, true}) {
        const cl::UserEvent gate(gpu_.context);
        const std::vector<cl::Event> gates = {gate};
        cl::Event event;
        gpu_.queue.enqueueFillBuffer(values_.get().buffer(), cl_uint{0}, 0,
                                     kCount * sizeof(cl_uint), &gates, &event);
        timer_.record("fill", event, is_first);
        gpu_.queue.flush();
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        cl::UserEvent(gate).setStatus(CL_COMPLETE);
        timer_.take();
        EXPECT_GE(is_first ? timer_.first_launch_ms() : timer_.launch_ms(), 90.0);
        EXPECT_LT(is_first ? timer_.launch_ms() : timer_.first_launch_ms(), 50.0);
    }
}

}  // namespace
}  // namespace kilolux
