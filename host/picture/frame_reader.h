// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <functional>
#include <list>
#include <span>
#include <vector>

#include "host/gpu/device.h"
#include "host/gpu/flow.h"
#include "host/gpu/memory/pinned_memory.h"
#include "host/gpu/stage_timer.h"

namespace kilolux {

/// Brings bands of a frame from the device to the host, without waiting for the device: through
/// pinned memory where the device has memory of its own. A second read into the same place replaces
/// the first.
class FrameReader {
 public:
    explicit FrameReader(const Gpu& gpu) : gpu_(gpu) {}

    /// Enqueues the read of a band's sRGB pixels, uint[height][stride]. finish() puts them into
    /// `pixels`, rows `to_stride` apart, which must outlive it.
    void read_display(const cl::Buffer& display, const View& view, std::span<uint> pixels,
                      std::size_t to_stride, StageTimer& timer);

    /// Enqueues the read of a band's light. finish() puts it into `rgb`, the interleaved light of
    /// the whole frame.
    void read_light(const Radiance& radiance, std::vector<float>& rgb, StageTimer& timer);

    /// Forgets reads that were not finished: those of a frame that failed.
    void reset();

    /// Waits for the device and puts everything that was read into its place. Returns the host's
    /// share of the time [ms].
    double finish();

 private:
    // A band's planes on their way, and the function that puts them into their place.
    struct Staged {
        explicit Staged(const Gpu& gpu) : pinned(gpu) {}
        PinnedMemory pinned;
        const void* place = nullptr;  // null: nothing was read
        std::function<void()> put;
    };

    Staged& staged_for(const void* place);
    const std::byte* read(Staged& staged, const cl::Buffer& buffer, std::size_t bytes,
                          StageTimer& timer);

    Gpu gpu_;
    std::list<Staged> staged_;
};

/// Waits for a queue when an exception leaves its scope: memory that the queue still writes must
/// outlive this.
class QueueDrain {
 public:
    explicit QueueDrain(const cl::CommandQueue& queue) : queue_(queue) {}
    ~QueueDrain() {
        if (std::uncaught_exceptions() > exceptions_) clFinish(queue_());
    }
    QueueDrain(const QueueDrain&) = delete;
    QueueDrain& operator=(const QueueDrain&) = delete;

 private:
    cl::CommandQueue queue_;
    int exceptions_ = std::uncaught_exceptions();
};

}  // namespace kilolux
