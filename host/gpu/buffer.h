// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CL/opencl.hpp>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "host/gpu/device.h"

namespace kilolux {

/// A device buffer that grows on demand and never shrinks; its contents are lost when it grows.
class GrowingBuffer {
   public:
    /// `owner` names the stage in error messages.
    GrowingBuffer(const Gpu& gpu, std::string_view owner) : gpu_(gpu), owner_(owner) {}

    /// The buffer with room for at least `bytes` (at least 16 are allocated).
    /// Throws Error with owner, need and limit when the device cannot provide it.
    const cl::Buffer& reserve(std::size_t bytes);
    const cl::Buffer& get() const { return buffer_; }
    std::size_t bytes() const { return bytes_; }

   private:
    Gpu gpu_;
    std::string owner_;
    cl::Buffer buffer_;
    std::size_t bytes_ = 0;
    std::shared_ptr<void> counted_;  // takes bytes_ off gpu_.allocated_bytes when the last copy goes
};

/// Copies `values` to `buffer`; blocks until the host memory may be reused.
template <typename T>
void upload(const Gpu& gpu, const cl::Buffer& buffer, std::span<const T> values) {
    if (!values.empty()) gpu.queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, values.size_bytes(), values.data());
}

/// Reads `count` values; blocks until everything enqueued before is done.
template <typename T>
std::vector<T> download(const Gpu& gpu, const cl::Buffer& buffer, std::size_t count, std::size_t first = 0) {
    std::vector<T> values(count);
    if (count > 0) gpu.queue.enqueueReadBuffer(buffer, CL_TRUE, first * sizeof(T), count * sizeof(T), values.data());
    return values;
}

}  // namespace kilolux
