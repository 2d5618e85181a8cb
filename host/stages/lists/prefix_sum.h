// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/buffer.h"
#include "host/gpu/features.h"
#include "host/gpu/kernel.h"
#include "host/gpu/memory/host_value.h"
#include "host/gpu/stage_info.h"

namespace kilolux {

/// The work of a prefix sum of `counts` numbers, as part of a stage: reads each count twice, writes
/// each offset.
inline StageWork prefix_sum_work(double counts) {
    return {.bytes_read = 2.0 * kWordBytes * counts,
            .bytes_written = kWordBytes * counts,
            .launches = 1};  // many blocks take three
}

/// Exclusive prefix sum of uint counts on the device.
class PrefixSum {
 public:
    /// Times and errors count to `stage`.
    PrefixSum(const Gpu& gpu, const Tuning& tuning, std::string_view stage);

    /// offsets[i] = counts[0] + ... + counts[i - 1] for i in 0..n: `offsets` holds n + 1. `counts`
    /// and `offsets` must not be the same buffer. Enqueues only.
    void enqueue(const DeviceArray<uint>& counts, uint n, const DeviceArray<uint>& offsets,
                 StageTimer& timer);

    /// The exact total of the last enqueue, in 64 bits: one element on the device.
    DeviceArray<std::uint64_t> total() const { return total_.get(); }

 private:
    Tuning tuning_;
    KernelProgram program_;
    Kernel few_, sum_blocks_, scan_totals_, apply_;
    GrowingArray<std::uint64_t> block_sums_, total_;
};

/// A list that a stage makes in three passes: count, prefix sum, fill. It keeps the room of the
/// last frame; the exact total says afterwards whether that was enough.
class CountedList {
 public:
    /// Entries of `entry_bytes` each, which `entries` names in error messages.
    CountedList(const Gpu& gpu, const Tuning& tuning, std::string_view stage,
                std::string_view entries, std::size_t entry_bytes);

    /// Makes room for at least `entries`.
    void reserve(std::size_t entries) { entries_.reserve(entries * entry_bytes_); }

    /// Room for `n` counts, which the caller's kernel writes.
    DeviceArray<uint> counts(std::size_t n) { return counts_.reserve(n); }

    /// Enqueues the prefix sum of the first `n` counts. Returns the offsets, [n + 1].
    DeviceArray<uint> enqueue_offsets(uint n, StageTimer& timer);

    template <typename T>
    DeviceArray<T> entries() const {
        return entries_.array<T>(entries_.bytes() / sizeof(T));
    }
    /// Entries that there is room for: what a fill must not exceed.
    uint capacity() const;

    /// Entries that the last prefix sum counted: one element on the device. Blocks nothing.
    DeviceArray<std::uint64_t> total() const { return prefix_sum_.total(); }
    /// Starts to copy it to the host, without a wait: read_total() then waits only for the copy.
    void start_read(StageTimer& timer);
    /// The same number on the host. Blocks.
    std::uint64_t read_total() const;

    /// True if there is room for `entries`, the total of the last enqueue; else makes room, with an
    /// eighth more where it fits, so that moving lights do not grow it frame by frame. Throws Error
    /// when 32-bit offsets, the device or the budget cannot hold them.
    bool fits(std::uint64_t entries);

 private:
    Gpu gpu_;
    std::string stage_, name_;
    std::size_t entry_bytes_;
    PrefixSum prefix_sum_;
    GrowingArray<uint> counts_, offsets_;
    GrowingBuffer entries_;
    HostValue<std::uint64_t> total_;
};

}  // namespace kilolux
