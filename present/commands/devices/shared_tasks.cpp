// SPDX-License-Identifier: Apache-2.0
#include "present/commands/devices/shared_tasks.h"

#include <utility>

namespace kilolux {

SharedTasks::SharedTasks(std::size_t first, std::size_t end, std::size_t ahead)
    : next_(first), end_(end), ahead_(ahead), unfinished_(first) {}

std::optional<std::size_t> SharedTasks::take() {
    std::unique_lock lock(mutex_);
    const auto is_open = [&] { return next_ < end_ && next_ < unfinished_ + ahead_; };
    changed_.wait(
        lock, [&] { return failure_ || unfinished_ == end_ || !returned_.empty() || is_open(); });
    if (failure_) return std::nullopt;
    if (!returned_.empty()) return returned_.extract(returned_.begin()).value();
    if (is_open()) return next_++;
    return std::nullopt;
}

void SharedTasks::deliver(std::size_t task, std::function<void()> finish) {
    std::unique_lock lock(mutex_);
    delivered_.emplace(task, std::move(finish));
    if (is_finishing_) return;  // by another thread
    is_finishing_ = true;
    while (!cannot_finish_) {
        const auto next = delivered_.find(unfinished_);
        if (next == delivered_.end()) break;
        const std::function<void()> call = std::move(next->second);
        delivered_.erase(next);
        lock.unlock();
        std::exception_ptr failure;
        try {
            call();
        } catch (...) {
            failure = std::current_exception();
        }
        lock.lock();
        if (failure) {
            if (!failure_) failure_ = failure;
            cannot_finish_ = true;
        } else {
            ++unfinished_;
        }
        changed_.notify_all();
    }
    is_finishing_ = false;
}

void SharedTasks::give_back(std::size_t task) {
    const std::scoped_lock lock(mutex_);
    returned_.insert(task);
    changed_.notify_all();
}

void SharedTasks::fail(std::exception_ptr failure) {
    const std::scoped_lock lock(mutex_);
    if (!failure_) failure_ = std::move(failure);
    changed_.notify_all();
}

void SharedTasks::rethrow() {
    const std::scoped_lock lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
}

}  // namespace kilolux
