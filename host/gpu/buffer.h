// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CL/opencl.hpp>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/gpu/device.h"
#include "kernels/shared/types.h"

namespace kilolux {

/// A buffer's share of a budget, given back with it.
class BufferCharge {
 public:
    BufferCharge(std::shared_ptr<MemoryBudget> budget, std::uint64_t bytes)
        : budget_(std::move(budget)), bytes_(bytes) {
        budget_->used += bytes_;
    }
    BufferCharge(const BufferCharge&) = delete;
    BufferCharge& operator=(const BufferCharge&) = delete;
    ~BufferCharge() { budget_->used -= bytes_; }
    std::uint64_t bytes() const { return bytes_; }

 private:
    std::shared_ptr<MemoryBudget> budget_;
    std::uint64_t bytes_;
};

/// Elements on the device: a buffer and how many there are. Copies share the memory, and the
/// budget counts it until the last copy is gone.
template <typename T>
class DeviceArray {
 public:
    using value_type = T;

    DeviceArray() = default;
    DeviceArray(cl::Buffer buffer, std::size_t count,
                std::shared_ptr<const BufferCharge> charge = {})
        : buffer_(std::move(buffer)), count_(count), charge_(std::move(charge)) {}
    /// The whole of a caller's own buffer.
    DeviceArray(cl::Buffer buffer) : buffer_(std::move(buffer)) {
        if (buffer_()) count_ = buffer_.getInfo<CL_MEM_SIZE>() / sizeof(T);
    }

    const cl::Buffer& buffer() const { return buffer_; }
    operator const cl::Buffer&() const { return buffer_; }
    std::size_t count() const { return count_; }

 private:
    cl::Buffer buffer_;
    std::size_t count_ = 0;
    std::shared_ptr<const BufferCharge> charge_;
};

/// A device buffer that grows on demand and never shrinks; its contents are lost when it grows.
class GrowingBuffer {
 public:
    /// `owner` names the stage in error messages.
    GrowingBuffer(const Gpu& gpu, std::string_view owner) : gpu_(gpu), owner_(owner) {}

    /// The buffer with room for at least `bytes` (at least 16 are allocated). When it must grow, it
    /// grows by `slack` more if device and budget allow. The old buffer is released first; where a
    /// caller still holds it, the budget counts both.
    /// Throws Error with owner, need and limit when the device cannot provide `bytes` or the budget
    /// does not allow them.
    const cl::Buffer& reserve(std::size_t bytes, std::size_t slack = 0);
    const cl::Buffer& get() const { return buffer_; }
    std::size_t bytes() const { return bytes_; }

    /// The first `count` elements.
    template <typename T>
    DeviceArray<T> array(std::size_t count) const {
        return {buffer_, count, charge_};
    }

 private:
    std::string refusal(std::size_t bytes) const;
    void allocate(std::size_t bytes);

    Gpu gpu_;
    std::string owner_;
    cl::Buffer buffer_;
    std::size_t bytes_ = 0;
    std::shared_ptr<const BufferCharge> charge_;
};

/// A GrowingBuffer of elements of one type.
template <typename T>
class GrowingArray {
 public:
    GrowingArray(const Gpu& gpu, std::string_view owner) : buffer_(gpu, owner) {}

    /// `count` elements; what is there is lost where the buffer had to grow.
    DeviceArray<T> reserve(std::size_t count) {
        buffer_.reserve(count * sizeof(T));
        count_ = count;
        return get();
    }
    /// The elements of the last reserve().
    DeviceArray<T> get() const { return buffer_.array<T>(count_); }

 private:
    GrowingBuffer buffer_;
    std::size_t count_ = 0;
};

/// Copies `values` to `buffer`; blocks until the host memory may be reused.
template <typename T>
void upload(const Gpu& gpu, const cl::Buffer& buffer, std::span<const T> values) {
    if (!values.empty())
        gpu.queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, values.size_bytes(), values.data());
}

/// The same without waiting: `values` must not change before the event.
template <typename T>
cl::Event start_upload(const Gpu& gpu, const cl::Buffer& buffer, const std::vector<T>& values) {
    cl::Event done;
    gpu.queue.enqueueWriteBuffer(buffer, CL_FALSE, 0, values.size() * sizeof(T), values.data(),
                                 nullptr, &done);
    return done;
}

/// Reads `count` values from number `first` on; blocks until everything enqueued before is done.
template <typename T>
std::vector<T> download(const Gpu& gpu, const cl::Buffer& buffer, std::size_t count,
                        std::size_t first = 0) {
    std::vector<T> values(count);
    if (count > 0)
        gpu.queue.enqueueReadBuffer(buffer, CL_TRUE, first * sizeof(T), count * sizeof(T),
                                    values.data());
    return values;
}

template <typename T>
std::vector<T> download(const Gpu& gpu, const DeviceArray<T>& array, std::size_t count,
                        std::size_t first = 0) {
    return download<T>(gpu, array.buffer(), count, first);
}

template <typename T>
std::vector<T> download(const Gpu& gpu, const DeviceArray<T>& array) {
    return download<T>(gpu, array.buffer(), array.count());
}

/// Light indices of a list of `bits`, 16 or 32, widened. Blocks.
std::vector<uint> download_indices(const Gpu& gpu, const cl::Buffer& list, int bits,
                                   std::size_t count, std::size_t first = 0);

}  // namespace kilolux
