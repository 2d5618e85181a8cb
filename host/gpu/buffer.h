// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CL/opencl.hpp>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "host/gpu/device.h"

namespace kilolux {

/// A buffer's share of a budget, given back with it.
class BufferCharge {
 public:
    BufferCharge() = default;
    BufferCharge(std::shared_ptr<MemoryBudget> budget, std::uint64_t bytes)
        : budget_(std::move(budget)), bytes_(budget_ ? bytes : 0) {
        if (budget_) budget_->used += bytes_;
    }
    BufferCharge(BufferCharge&& other) noexcept
        : budget_(std::move(other.budget_)), bytes_(std::exchange(other.bytes_, 0)) {}
    BufferCharge& operator=(BufferCharge&& other) noexcept {
        std::swap(budget_, other.budget_);
        std::swap(bytes_, other.bytes_);
        return *this;
    }
    BufferCharge(const BufferCharge&) = delete;
    BufferCharge& operator=(const BufferCharge&) = delete;
    ~BufferCharge() {
        if (budget_) budget_->used -= bytes_;
    }
    std::uint64_t bytes() const { return bytes_; }

 private:
    std::shared_ptr<MemoryBudget> budget_;
    std::uint64_t bytes_ = 0;
};

/// A device buffer that grows on demand and never shrinks; its contents are lost when it grows.
class GrowingBuffer {
 public:
    /// `owner` names the stage in error messages.
    GrowingBuffer(const Gpu& gpu, std::string_view owner) : gpu_(gpu), owner_(owner) {}

    /// The buffer with room for at least `bytes` (at least 16 are allocated).
    /// Throws Error with owner, need and limit when the device cannot provide it or the budget
    /// does not allow it.
    const cl::Buffer& reserve(std::size_t bytes);
    const cl::Buffer& get() const { return buffer_; }
    std::size_t bytes() const { return bytes_; }

 private:
    void check(std::size_t bytes) const;

    Gpu gpu_;
    std::string owner_;
    cl::Buffer buffer_;
    std::size_t bytes_ = 0;
    BufferCharge charge_;
};

/// Copies `values` to `buffer`; blocks until the host memory may be reused.
template <typename T>
void upload(const Gpu& gpu, const cl::Buffer& buffer, std::span<const T> values) {
    if (!values.empty())
        gpu.queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, values.size_bytes(), values.data());
}

/// Reads `count` values; blocks until everything enqueued before is done.
template <typename T>
std::vector<T> download(const Gpu& gpu, const cl::Buffer& buffer, std::size_t count,
                        std::size_t first = 0) {
    std::vector<T> values(count);
    if (count > 0)
        gpu.queue.enqueueReadBuffer(buffer, CL_TRUE, first * sizeof(T), count * sizeof(T),
                                    values.data());
    return values;
}

/// Light indices of a list of `bits`, 16 or 32, widened to 32. Blocks.
inline std::vector<uint> download_indices(const Gpu& gpu, const cl::Buffer& list, int bits,
                                          std::size_t count, std::size_t first = 0) {
    if (bits == 32) return download<uint>(gpu, list, count, first);
    const auto narrow = download<std::uint16_t>(gpu, list, count, first);
    return {narrow.begin(), narrow.end()};
}

}  // namespace kilolux
