// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <vector>

#include "host/gpu/device.h"
#include "host/gpu/flow.h"
#include "host/picture/frame.h"

namespace kilolux {

/// Brings bands of a frame from the device to the host, without waiting for the device. What is
/// read twice is the later one.
class FrameReader {
 public:
    explicit FrameReader(const Gpu& gpu) : gpu_(gpu) {}

    /// Enqueues the read of a band's sRGB pixels, uint[height][stride], into the rows of
    /// `frame.display` that `view` names.
    void read_display(const cl::Buffer& display, const View& view, Frame& frame);

    /// Enqueues the read of a band's light. finish() puts it into `rgb`, the interleaved light of
    /// the whole frame.
    void read_light(const Radiance& radiance, std::vector<float>& rgb);

    /// Waits for the device; then all that was read is in its place.
    void finish();

 private:
    struct Light {
        View view{};
        std::vector<float> planes;
        std::vector<float>* rgb = nullptr;
    };
    Gpu gpu_;
    std::vector<Light> lights_;
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
