// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "host/gpu/buffer.h"
#include "host/gpu/program.h"
#include "host/measure/roofline/device_limits.h"

namespace kilolux {

/// Independent chains of kernels/limits/measure_limits.cl.
inline constexpr int kFmaChains = 10;
inline constexpr int kAddChains = 4;
/// Of kernels/limits/measure_texels.cl: texels of the table, and texels of an iteration.
inline constexpr int kTexels = 1024;
inline constexpr int kTexelChains = 4;
/// Assumed where a device does not report its cache [byte].
inline constexpr std::uint64_t kSmallestCache = 1 << 20;

/// Size of a buffer larger than every cache, as far as the device's memory allows [byte].
std::uint64_t large_buffer_bytes(const DeviceInfo& device);

/// Size of one of two buffers that fit the last cache but not the nearer ones [byte].
std::uint64_t cached_buffer_bytes(const DeviceInfo& device);

/// [byte/s]; copy counts both ways.
struct MemoryRates {
    double read = 0.0;
    double write = 0.0;
    double copy = 0.0;
};

/// Runs kernels/limits/measure_limits.cl and measure_texels.cl; each rate is the best of several
/// runs. Memory at the Gpu's lane width; arithmetic, where that is a CPU's own, also at twice the
/// width, which shading uses and which AVX-512 needs for its full rate.
class LimitKernels {
 public:
    explicit LimitKernels(const Gpu& gpu);

    /// Operations per second of a *_rate kernel that does `operations` a lane and iteration.
    double lane_operations_per_s(const char* kernel, int operations);

    /// Texels per second that lanes read from a table in the nearest cache.
    double texels_per_s();

    /// Rates of reading, writing and copying, measured on two filled buffers of `bytes` each.
    MemoryRates memory_rates(std::uint64_t bytes);

    /// Sets the bandwidths between host and device and the times of an empty kernel.
    void measure_transfers(DeviceLimits& limits);
    void measure_launch(DeviceLimits& limits);

 private:
    struct Walk;
    double walk_bytes_per_s(const char* kernel, const Walk& walk);

    Gpu gpu_;
    KernelProgram program_;
    struct Width {
        int lanes;
        KernelProgram program, texels;
    };
    std::vector<Width> widths_;  // of the *_rate kernels
    std::size_t group_;          // work-items of a group
    std::size_t items_;          // work-items of the *_rate kernels
    std::size_t walkers_;        // work-items that share a buffer
    cl::Buffer out_;
    cl::Buffer texels_;  // a table
};

}  // namespace kilolux
