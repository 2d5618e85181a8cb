// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/device.h"

namespace kilolux {

class LimitKernels;

/// What a device does at best, measured: the roofs that stages' times stand against.
///
/// "Lane operations" count each lane of an FV by itself, so that devices of every width compare.
/// Bandwidths are of buffers that were written before (reading untouched memory reads one page of
/// zeros); copying counts the bytes read and those written.
struct DeviceLimits {
    int lanes = 1;                         // FV's width in the measurement: the device's own
    double fma_flops = 0.0;                // two per fused multiply-add [1/s]
    double one_lane_fma_flops = 0.0;       // the same kernel with one lane a work-item [1/s]
    double lane_instructions_per_s = 0.0;  // additions and multiply-adds as evaluate() mixes them
    double rsqrt_per_s = 0.0;              // as the compiler makes them from OpenCL C's functions
    double sqrt_per_s = 0.0;
    double divisions_per_s = 0.0;
    double read_bandwidth = 0.0;  // [byte/s], buffers larger than every cache
    double write_bandwidth = 0.0;
    double copy_bandwidth = 0.0;
    double cached_read_bandwidth = 0.0;  // [byte/s], buffers that fit the last cache
    double cached_write_bandwidth = 0.0;
    double cached_copy_bandwidth = 0.0;
    double cache_bytes = 0.0;       // what the device says of its largest cache
    double upload_bandwidth = 0.0;  // [byte/s], host memory to the device and back
    double download_bandwidth = 0.0;
    double launch_latency_ms = 0.0;  // empty kernel and waiting for it, on the host
    double launch_event_ms = 0.0;    // the same by the kernel's own events
    bool operator==(const DeviceLimits&) const = default;

    /// How many lanes' work an instruction does: near `lanes` on CPUs whose vector unit is in use,
    /// near 1 on GPUs, where every work-item is a lane of the hardware already.
    double effective_lanes() const {
        return one_lane_fma_flops > 0.0 ? fma_flops / one_lane_fma_flops : 0.0;
    }
};

/// Measures the device; one to four seconds. The best of several runs counts, as other work on the
/// machine can only slow it. Throws Error when a kernel fails.
DeviceLimits measure_device_limits(const Gpu& gpu);

/// Measures the arithmetic again and keeps what is better: between the runs of a benchmark, so that
/// limits and runs see the same machine. Whether a rate rose by more than a hundredth.
bool raise_arithmetic_limits(DeviceLimits& limits, LimitKernels& natural_lanes);

/// The same until it raises nothing three times in a row; three seconds at most. One measurement
/// alone was 1.9 times too low once, on a machine with other work, and so every ratio to it wrong.
void settle_arithmetic_limits(DeviceLimits& limits, LimitKernels& natural_lanes);

/// Keeps limits in the user's cache folder; a warning says so where that cannot be.
void keep_device_limits(const DeviceInfo& device, const DeviceLimits& limits);

/// The limits kept in the user's cache folder, or measured and kept. Where they cannot be kept, a
/// warning says so and they are measured anew the next time. `measure_again`: ignore what is kept.
DeviceLimits cached_device_limits(const Gpu& gpu, bool measure_again = false);

}  // namespace kilolux
