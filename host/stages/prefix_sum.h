// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/buffer.h"
#include "host/gpu/features.h"
#include "host/gpu/stage_timer.h"

namespace kilolux {

/// Exclusive prefix sum of uint counts on the device.
class PrefixSum {
 public:
    PrefixSum(const Gpu& gpu, const Tuning& tuning);

    /// offsets[i] = counts[0] + ... + counts[i - 1] for i in 0..n: `offsets` holds n + 1. `counts`
    /// and `offsets` must not be the same buffer. Enqueues only; its time counts to `stage`.
    void enqueue(const cl::Buffer& counts, uint n, const cl::Buffer& offsets, StageTimer& timer,
                 std::string_view stage);

    /// The exact total of the last enqueue, in 64 bits; blocks until it is there.
    std::uint64_t total() const;

 private:
    Gpu gpu_;
    Tuning tuning_;
    cl::Program program_;
    GrowingBuffer block_sums_, total_;
};

/// Throws Error if a list needs more entries than 32-bit offsets address; else the count as 32
/// bits.
uint checked_list_size(std::uint64_t entries, std::string_view stage);

}  // namespace kilolux
