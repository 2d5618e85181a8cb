// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/task_thread.h"

namespace kilolux {

TaskThread::TaskThread(Call begin, Call end, Call wake)
    : begin_(std::move(begin)),
      end_(std::move(end)),
      wake_(std::move(wake)),
      thread_([this] { run(); }) {}

TaskThread::~TaskThread() {
    stop({});
    thread_.join();
}

void TaskThread::push(Task task) {
    {
        const std::lock_guard lock(mutex_);
        tasks_.push_back(std::move(task));
    }
    changed_.notify_all();
}

void TaskThread::replace(Call run) {
    {
        const std::lock_guard lock(mutex_);
        latest_.swap(run);
    }
    changed_.notify_all();
}

void TaskThread::check_begun() const {
    const std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
}

bool TaskThread::stop(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    stopping_ = true;
    latest_ = nullptr;
    std::erase_if(tasks_, [](const Task& task) { return task.at_stop == AtStop::drop; });
    changed_.notify_all();
    changed_.wait(lock, [this] { return ended_ || (tasks_.empty() && !must_finish_); });
    return changed_.wait_for(lock, patience, [this] { return ended_; });
}

void TaskThread::run() {
    try {
        begin_();
        work();
    } catch (...) {
        const std::lock_guard lock(mutex_);
        failure_ = std::current_exception();
    }
    end_();
    {
        const std::lock_guard lock(mutex_);
        tasks_.clear();
        ended_ = true;
    }
    changed_.notify_all();
    wake_();
}

void TaskThread::work() {
    while (std::optional<Task> task = next()) {
        task->run();
        task.reset();  // destroys its captures in this thread
        {
            const std::lock_guard lock(mutex_);
            must_finish_ = false;
        }
        changed_.notify_all();
        wake_();
    }
}

// Waits for a task; none once the thread is stopped.
std::optional<TaskThread::Task> TaskThread::next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stopping_ || !tasks_.empty() || latest_; });
    std::optional<Task> task;
    if (!tasks_.empty()) {
        task = std::move(tasks_.front());
        tasks_.pop_front();
    } else if (latest_) {
        task = Task{std::exchange(latest_, nullptr)};
    } else {
        return std::nullopt;
    }
    must_finish_ = task->at_stop == AtStop::finish;
    return task;
}

}  // namespace kilolux
