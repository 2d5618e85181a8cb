// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>

namespace kilolux {

/// The tasks of a sequence, which several threads do at once; what is done is finished in the order
/// of the tasks, one at a time. All functions may be called by any thread.
class SharedTasks {
 public:
    /// Tasks `first` to `end` - 1. `ahead`: how many tasks, from the first unfinished one on, may
    /// be out at once.
    SharedTasks(std::size_t first, std::size_t end, std::size_t ahead);

    /// The next task; waits while none may be taken. None: all are finished, or fail() was called.
    std::optional<std::size_t> take();

    /// Has `finish` called for a task that was taken, by this thread or another one, after those
    /// before it. Where a call throws, fail() follows, and no other is called.
    void deliver(std::size_t task, std::function<void()> finish);

    /// Another thread is to do a task that was taken.
    void give_back(std::size_t task);

    /// No task is taken any more; those delivered are finished as far as none before them lacks.
    void fail(std::exception_ptr failure);

    /// Throws the first failure.
    void rethrow();

 private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::size_t next_, end_, ahead_;
    std::size_t unfinished_;  // the first one
    bool is_finishing_ = false;
    bool cannot_finish_ = false;
    std::exception_ptr failure_;
    std::set<std::size_t> returned_;
    std::map<std::size_t, std::function<void()>> delivered_;
};

}  // namespace kilolux
