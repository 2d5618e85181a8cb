// SPDX-License-Identifier: Apache-2.0
#include "present/commands/devices/shared_tasks.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace kilolux {
namespace {

using std::chrono::milliseconds;

TEST(SharedTasks, AreFinishedInOrder) {
    SharedTasks tasks(3, 40, 8);
    std::vector<std::size_t> finished;
    {
        std::vector<std::jthread> threads;
        for (std::size_t t = 0; t < 4; ++t) {
            threads.emplace_back([&, t] {
                while (const auto task = tasks.take()) {
                    std::this_thread::sleep_for(milliseconds((*task * 7 + t) % 5));
                    tasks.deliver(*task, [&finished, i = *task] { finished.push_back(i); });
                }
            });
        }
    }
    ASSERT_EQ(finished.size(), 37u);
    for (std::size_t i = 0; i < finished.size(); ++i) EXPECT_EQ(finished[i], i + 3);
    tasks.rethrow();
}

TEST(SharedTasks, AreTakenAFewAhead) {
    SharedTasks tasks(0, 10, 2);
    EXPECT_EQ(tasks.take(), 0u);
    EXPECT_EQ(tasks.take(), 1u);
    std::atomic<int> third = -1;
    std::jthread waiting([&] { third = static_cast<int>(*tasks.take()); });
    tasks.deliver(1, [] {});
    std::this_thread::sleep_for(milliseconds(50));
    EXPECT_EQ(third, -1) << "the first one is not finished";
    tasks.deliver(0, [] {});
    waiting.join();
    EXPECT_EQ(third, 2);
}

TEST(SharedTasks, AreTakenAgainWhereTheyWereGivenBack) {
    SharedTasks tasks(0, 2, 2);
    int finished = 0;
    EXPECT_EQ(tasks.take(), 0u);
    EXPECT_EQ(tasks.take(), 1u);
    tasks.deliver(1, [&] { ++finished; });
    std::jthread other([&] {  // waits, since the first task may be given back
        while (const auto task = tasks.take()) tasks.deliver(*task, [&] { ++finished; });
    });
    std::this_thread::sleep_for(milliseconds(20));
    tasks.give_back(0);
    other.join();
    EXPECT_EQ(finished, 2);
    EXPECT_EQ(tasks.take(), std::nullopt);
}

TEST(SharedTasks, StopWhereOneCannotBeFinished) {
    SharedTasks tasks(0, 5, 5);
    int finished = 0;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(tasks.take(), i);
    tasks.deliver(1, [] { throw std::runtime_error("the disk is full"); });
    tasks.deliver(2, [&] { ++finished; });
    tasks.deliver(0, [&] { ++finished; });
    EXPECT_EQ(finished, 1);
    EXPECT_EQ(tasks.take(), std::nullopt);
    EXPECT_THROW(tasks.rethrow(), std::runtime_error);
}

// What is done already is finished.
TEST(SharedTasks, AreNotTakenAfterAFailure) {
    SharedTasks tasks(0, 5, 2);
    EXPECT_EQ(tasks.take(), 0u);
    EXPECT_EQ(tasks.take(), 1u);
    std::jthread waiting([&] { EXPECT_EQ(tasks.take(), std::nullopt); });
    tasks.fail(std::make_exception_ptr(std::runtime_error("interrupted")));
    waiting.join();
    int finished = 0;
    tasks.deliver(1, [&] { ++finished; });
    EXPECT_EQ(finished, 0) << "the first one lacks";
    tasks.deliver(0, [&] { ++finished; });
    EXPECT_EQ(finished, 2);
    EXPECT_THROW(tasks.rethrow(), std::runtime_error);
}

}  // namespace
}  // namespace kilolux
