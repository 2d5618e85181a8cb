// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <type_traits>
#include <utility>

namespace kilolux {

/// What happens to a waiting task when its thread is stopped.
enum class AtStop { drop, finish };

/// Runs tasks one after the other in a thread of its own. The future of a task that was dropped
/// throws std::future_error.
class TaskThread {
 public:
    using Call = std::function<void()>;

    /// `begin` runs first in the thread and `end` last; `wake` runs in it after every task. When
    /// `begin` throws, no task runs.
    TaskThread(Call begin, Call end, Call wake);
    /// Stops, however long the running task takes.
    ~TaskThread();
    TaskThread(const TaskThread&) = delete;
    TaskThread& operator=(const TaskThread&) = delete;

    /// Runs `work` after the tasks before it.
    template <typename Work>
    auto ask(Work work, AtStop at_stop = AtStop::drop) {
        auto [task, result] = packaged(std::move(work));
        push({std::move(task), at_stop});
        return std::move(result);
    }

    /// Runs `work` when no other task waits. It replaces the last such work that has not begun.
    template <typename Work>
    auto ask_latest(Work work) {
        auto [task, result] = packaged(std::move(work));
        replace(std::move(task));
        return std::move(result);
    }

    /// Throws the exception of `begin`.
    void check_begun() const;

    /// Whether a long task should give up.
    bool is_stopping() const { return stopping_; }

    /// Drops waiting tasks, waits for those that must finish, and at most `patience` for any other.
    /// Returns whether the thread has ended.
    bool stop(std::chrono::milliseconds patience);

 private:
    struct Task {
        Call run;
        AtStop at_stop = AtStop::drop;
    };

    template <typename Work>
    static auto packaged(Work work) {
        using Answer = std::invoke_result_t<Work>;
        auto task = std::make_shared<std::packaged_task<Answer()>>(std::move(work));
        std::future<Answer> result = task->get_future();
        return std::pair{Call([task] { (*task)(); }), std::move(result)};
    }
    void push(Task task);
    void replace(Call run);
    void run();
    void work();
    std::optional<Task> next();

    Call begin_, end_, wake_;
    mutable std::mutex mutex_;  // guards all below but the thread
    std::condition_variable changed_;
    std::deque<Task> tasks_;
    Call latest_;
    bool must_finish_ = false;  // the running task
    bool ended_ = false;
    std::exception_ptr failure_;  // of begin_
    std::atomic<bool> stopping_ = false;
    std::thread thread_;
};

}  // namespace kilolux
