// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "host/gpu/buffer.h"
#include "host/gpu/memory/pinned_memory.h"
#include "host/gpu/stage_timer.h"

namespace kilolux {

/// A small value on the device, copied to the host without blocking. Work that is enqueued between
/// start() and get() keeps the device busy while the host waits.
template <typename T>
class HostValue {
 public:
    explicit HostValue(const Gpu& gpu)
        : queue_(gpu.queue), memory_(std::make_unique<PinnedMemory>(gpu)) {
        memory_->reserve(sizeof(T));  // waits for the device, so not in start()
    }

    /// Enqueues the copy of `value`, one element, which counts to `stage`. The array may be written
    /// and released afterwards.
    void start(const DeviceArray<T>& value, std::string_view stage, StageTimer& timer) {
        cl::Event done;
        queue_.enqueueReadBuffer(value.buffer(), CL_FALSE, 0, sizeof(T),
                                 memory_->template data<T>(), nullptr, &done);
        timer.record(stage, done);
        done_ = done;
    }
    bool is_started() const { return done_.has_value(); }

    /// What start(), which was called before, copied. Waits for it.
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
