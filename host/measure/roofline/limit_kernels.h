// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "host/gpu/buffer.h"
#include "host/gpu/program.h"

namespace kilolux {

/// Independent chains of kernels/measure_limits.cl.
inline constexpr int kFmaChains = 10;
inline constexpr int kAddChains = 4;
/// Of devices that do not report theirs [byte].
inline constexpr std::uint64_t kSmallestCache = 1 << 20;

/// [byte/s]; copy counts both ways.
struct MemoryRates {
    double read = 0.0;
    double write = 0.0;
    double copy = 0.0;
};

/// [byte/s] between host memory and the device.
struct TransferRates {
    double upload = 0.0;
    double download = 0.0;
};

/// Of an empty kernel [ms].
struct LaunchTimes {
    double finish_ms = 0.0;  // enqueued and waited for, on the host's clock
    double event_ms = 0.0;   // from start to end by its own event
};

/// Size of a buffer larger than every cache, as far as the device's memory allows [byte].
std::uint64_t large_buffer_bytes(const DeviceInfo& device);

/// Size of one of two buffers that fit the last cache but not the nearer ones [byte].
std::uint64_t cached_buffer_bytes(const DeviceInfo& device);

/// Runs kernels/measure_limits.cl; each rate is the best of several runs. Memory at the Gpu's lane
/// width; arithmetic, where that is a CPU's own, also at twice the width, which shading uses and
/// which AVX-512 needs for its full rate.
class LimitKernels {
 public:
    explicit LimitKernels(const Gpu& gpu);

    /// Of a *_rate kernel that does `operations` a lane and iteration.
    double lane_operations_per_s(const char* kernel, int operations);

    /// Of two filled buffers of `bytes` each.
    MemoryRates memory_rates(std::uint64_t bytes);

    TransferRates transfer_rates();
    LaunchTimes launch_times();

 private:
    struct Walk;
    double walk_bytes_per_s(const char* kernel, const Walk& walk);

    Gpu gpu_;
    cl::Program program_;
    struct Width {
        int lanes;
        cl::Program program;
    };
    std::vector<Width> widths_;  // of the *_rate kernels
    std::size_t group_;          // work-items of a group
    std::size_t items_;          // work-items of the *_rate kernels
    std::size_t walkers_;        // work-items that share a buffer
    cl::Buffer out_;
};

}  // namespace kilolux
