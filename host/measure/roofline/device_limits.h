// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "host/gpu/device.h"

namespace kilolux {

class LimitKernels;

/// The highest rates of a device, as measured: the roofs of the roofline model.
///
/// Lane operations count each lane of an FV, so that devices of different widths compare.
/// Bandwidths are of buffers that were written before, as untouched memory is one page of zeros.
/// Copying counts the bytes read and written.
struct DeviceLimits {
    int lanes = 1;                         // the device's own FV width
    double fma_flops = 0.0;                // two per fused multiply-add [1/s]
    double one_lane_fma_flops = 0.0;       // the same kernel with one lane a work-item [1/s]
    double lane_instructions_per_s = 0.0;  // additions and multiply-adds as evaluate() mixes them
    double rsqrt_per_s = 0.0;              // OpenCL C's functions as compiled
    double sqrt_per_s = 0.0;
    double divisions_per_s = 0.0;
    double texels_per_s = 0.0;    // 64 bits each, as textures are read, from the nearest cache
    double read_bandwidth = 0.0;  // [byte/s], buffers larger than every cache
    double write_bandwidth = 0.0;
    double copy_bandwidth = 0.0;
    double cached_read_bandwidth = 0.0;  // [byte/s], buffers that fit the last cache
    double cached_write_bandwidth = 0.0;
    double cached_copy_bandwidth = 0.0;
    double cache_bytes = 0.0;       // of the largest cache, as the device says
    double upload_bandwidth = 0.0;  // [byte/s], host memory to the device and back
    double download_bandwidth = 0.0;
    double launch_latency_ms = 0.0;  // empty kernel and waiting for it, on the host
    double launch_event_ms = 0.0;    // the same by the kernel's events
    bool operator==(const DeviceLimits&) const = default;

    /// Speed-up by lanes: near `lanes` on CPUs with vector units, near 1 on GPUs, where a work-item
    /// is a hardware lane.
    double effective_lanes() const {
        return one_lane_fma_flops > 0.0 ? fma_flops / one_lane_fma_flops : 0.0;
    }
};

/// A limit by name, in its unit; the table has all but `lanes`.
struct LimitField {
    const char* name;
    double DeviceLimits::*value;
};
std::span<const LimitField> limit_fields();

/// Measures the device in one to four seconds. The best of several runs counts, as other work on
/// the machine only slows it. Throws Error when a kernel fails.
DeviceLimits measure_device_limits(const Gpu& gpu);

/// Measures the arithmetic again and keeps higher rates. Called between the runs of a benchmark, so
/// that other load slows limits and runs alike. Returns whether a rate rose by more than 1 %.
bool raise_arithmetic_limits(DeviceLimits& limits, LimitKernels& natural_lanes);

/// Raises the arithmetic limits until they converge: no rate rises three times in a row, or three
/// seconds have passed. A single measurement on a busy machine may be too low by a factor of 1.9.
void settle_arithmetic_limits(DeviceLimits& limits, LimitKernels& natural_lanes);

/// Keeps limits in the user's cache folder; warns where that cannot be written.
void keep_device_limits(const DeviceInfo& device, const DeviceLimits& limits);

/// The limits kept in the user's cache folder, else measured and kept. Warns where they cannot be
/// kept. `measure_again` ignores what is kept.
DeviceLimits cached_device_limits(const Gpu& gpu, bool measure_again = false);

}  // namespace kilolux
