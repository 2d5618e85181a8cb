// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "host/gpu/buffer.h"
#include "host/gpu/memory/pinned_memory.h"
#include "host/gpu/stage_timer.h"

namespace kilolux {

/// A number, or a few, that the device computes, on its way to the host: what is enqueued between
/// start() and get() keeps the device busy while the host waits.
template <typename T>
class HostValue {
 public:
    explicit HostValue(const Gpu& gpu)
        : queue_(gpu.queue), memory_(std::make_unique<PinnedMemory>(gpu)) {}

    /// Enqueues the copy of `value`, one element, which counts to `stage`. The array may be written
    /// and released afterwards.
    void start(const DeviceArray<T>& value, std::string_view stage, StageTimer& timer) {
        void* to = memory_->reserve(sizeof(T));
        done_.emplace();
        queue_.enqueueReadBuffer(value.buffer(), CL_FALSE, 0, sizeof(T), to, nullptr, &*done_);
        timer.record(stage, *done_);
    }
    bool is_started() const { return done_.has_value(); }

    /// What start() copied. Waits for it.
    T get() const {
        done_->wait();
        return *memory_->template data<T>();
    }

    /// Forgets a copy that was started.
    void drop() { done_.reset(); }

 private:
    cl::CommandQueue queue_;
    std::unique_ptr<PinnedMemory> memory_;
    std::optional<cl::Event> done_;
};

}  // namespace kilolux
