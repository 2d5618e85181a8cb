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
    /// Tasks `first` to `end` - 1. `ahead`: how many tasks after the first unfinished one may be
    /// taken.
    SharedTasks(std::size_t first, std::size_t end, std::size_t ahead);

    /// The next task; waits while none may be taken. None: all are finished, or stop() was called.
    std::optional<std::size_t> take();

    /// Has `finish` called for a task that was taken, by this thread or another one, after those
    /// before it. Where a call throws, stop() follows.
    void deliver(std::size_t task, std::function<void()> finish);

    /// Another thread is to do a task that was taken.
    void give_back(std::size_t task);

    /// No task is taken and none is finished any more.
    void stop();

    /// Throws what a call of `finish` threw.
    void rethrow();

 private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::size_t next_, end_, ahead_;
    std::size_t unfinished_;  // the first one
    bool is_finishing_ = false;
    bool is_stopped_ = false;
    std::exception_ptr failure_;
    std::set<std::size_t> returned_;
    std::map<std::size_t, std::function<void()>> delivered_;
};

}  // namespace kilolux
