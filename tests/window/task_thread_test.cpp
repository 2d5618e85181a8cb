// SPDX-License-Identifier: Apache-2.0
// These run under the thread sanitizer, too.
#include "present/window/app/task_thread.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace kilolux {
namespace {

using std::chrono::milliseconds;

// A task that runs until the test releases it.
class Gate {
 public:
    /// Waits until the task has begun.
    void wait() { begun_.get_future().wait(); }
    void open() { open_.set_value(); }
    auto task() {
        return [this, open = open_.get_future().share()] {
            begun_.set_value();
            open.wait();
        };
    }

 private:
    std::promise<void> begun_, open_;
};

TEST(TaskThread, RunsTasksInTheirOrderAndTheLatestBehindThem) {
    std::vector<int> done;
    std::atomic<int> wakes = 0;
    {
        TaskThread thread([&] { done.push_back(0); }, [&] { done.push_back(9); }, [&] { ++wakes; });
        Gate gate;
        thread.ask(gate.task());
        gate.wait();
        auto last = thread.ask_latest([&] { return done.push_back(3), 33; });
        thread.ask([&] { done.push_back(1); });
        auto second = thread.ask([&] { return done.push_back(2), 22; });
        gate.open();
        EXPECT_EQ(second.get(), 22);
        EXPECT_EQ(last.get(), 33);
    }
    EXPECT_EQ(done, (std::vector{0, 1, 2, 3, 9}));
    EXPECT_EQ(wakes, 5) << "four tasks and the end";
}

TEST(TaskThread, ALaterLatestReplacesTheOneThatHasNotBegun) {
    TaskThread thread([] {}, [] {}, [] {});
    Gate gate;
    auto running = thread.ask_latest(gate.task());
    gate.wait();
    auto replaced = thread.ask_latest([] { return 1; });
    auto latest = thread.ask_latest([] { return 2; });
    EXPECT_THROW(replaced.get(), std::future_error);
    gate.open();
    EXPECT_EQ(latest.get(), 2);
    running.get();
}

TEST(TaskThread, WhatATaskThrowsIsItsOwn) {
    TaskThread thread([] {}, [] {}, [] {});
    auto failing = thread.ask([]() -> int { throw std::runtime_error("no such pixel"); });
    auto odd = thread.ask([]() -> int { throw 42; });
    auto next = thread.ask([] { return 7; });
    EXPECT_THROW(failing.get(), std::runtime_error);
    EXPECT_THROW(odd.get(), int);
    EXPECT_EQ(next.get(), 7);
    thread.check_begun();
}

TEST(TaskThread, NothingRunsWhenTheBeginningFails) {
    TaskThread thread([] { throw std::runtime_error("no device"); }, [] {}, [] {});
    auto never = thread.ask([] { return 1; });
    EXPECT_TRUE(thread.stop(std::chrono::minutes(1)));
    EXPECT_THROW(thread.check_begun(), std::runtime_error);
}

TEST(TaskThread, StoppingWaitsForWhatMustFinishOnly) {
    bool written = false;
    TaskThread thread([] {}, [] {}, [] {});
    Gate gate;
    thread.ask(gate.task());
    gate.wait();
    auto dropped = thread.ask([] { return 1; });
    auto latest = thread.ask_latest([] { return 2; });
    thread.ask([&] { written = true; }, AtStop::finish);
    auto stopped = std::async([&] { return thread.stop(std::chrono::minutes(1)); });
    while (!thread.is_stopping()) std::this_thread::yield();
    gate.open();
    EXPECT_TRUE(stopped.get());
    EXPECT_TRUE(written);
    EXPECT_THROW(dropped.get(), std::future_error);
    EXPECT_THROW(latest.get(), std::future_error);
}

TEST(TaskThread, StoppingDoesNotWaitForLongTasks) {
    TaskThread thread([] {}, [] {}, [] {});
    Gate gate;
    thread.ask_latest(gate.task());
    gate.wait();
    EXPECT_FALSE(thread.stop(milliseconds(1)));
    gate.open();
    EXPECT_TRUE(thread.stop(std::chrono::minutes(1)));
}

}  // namespace
}  // namespace kilolux
