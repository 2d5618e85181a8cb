// SPDX-License-Identifier: Apache-2.0
#include "host/measure/roofline/device_limits.h"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/gpu/tuning/device_cache.h"
#include "host/measure/roofline/limit_kernels.h"

namespace kilolux {
namespace {

constexpr CacheKind kKind = {"limits", 4};

constexpr LimitField kFields[] = {
    {"fma_flops", &DeviceLimits::fma_flops},
    {"one_lane_fma_flops", &DeviceLimits::one_lane_fma_flops},
    {"lane_instructions_per_s", &DeviceLimits::lane_instructions_per_s},
    {"rsqrt_per_s", &DeviceLimits::rsqrt_per_s},
    {"sqrt_per_s", &DeviceLimits::sqrt_per_s},
    {"divisions_per_s", &DeviceLimits::divisions_per_s},
    {"texels_per_s", &DeviceLimits::texels_per_s},
    {"read_bytes_per_s", &DeviceLimits::read_bandwidth},
    {"write_bytes_per_s", &DeviceLimits::write_bandwidth},
    {"copy_bytes_per_s", &DeviceLimits::copy_bandwidth},
    {"cached_read_bytes_per_s", &DeviceLimits::cached_read_bandwidth},
    {"cached_write_bytes_per_s", &DeviceLimits::cached_write_bandwidth},
    {"cached_copy_bytes_per_s", &DeviceLimits::cached_copy_bandwidth},
    {"cache_bytes", &DeviceLimits::cache_bytes},
    {"upload_bytes_per_s", &DeviceLimits::upload_bandwidth},
    {"download_bytes_per_s", &DeviceLimits::download_bandwidth},
    {"launch_latency_ms", &DeviceLimits::launch_latency_ms},
    {"launch_event_ms", &DeviceLimits::launch_event_ms},
};

CacheValues values_of(const DeviceLimits& limits) {
    CacheValues values = {{"lanes", limits.lanes}};
    for (const LimitField& field : kFields) values.emplace(field.name, limits.*field.value);
    return values;
}

// Empty unless every limit is there and positive.
std::optional<DeviceLimits> limits_of(const CacheValues& values, int lanes) {
    const auto kept_lanes = values.find("lanes");
    if (kept_lanes == values.end() || kept_lanes->second != lanes) return std::nullopt;
    DeviceLimits limits;
    limits.lanes = lanes;
    for (const LimitField& field : kFields) {
        const auto found = values.find(field.name);
        if (found == values.end() || !(found->second > 0.0)) return std::nullopt;
        limits.*field.value = found->second;
    }
    return limits;
}

// Keeps the higher rate; returns whether it rose by more than 1 %.
bool raise(double& limit, double measured) {
    const bool better = measured > 1.01 * limit;
    limit = std::max(limit, measured);
    return better;
}

}  // namespace

std::span<const LimitField> limit_fields() { return kFields; }

bool raise_arithmetic_limits(DeviceLimits& limits, LimitKernels& kernels) {
    const auto rate = [&](const char* kernel, int operations) {
        return kernels.lane_operations_per_s(kernel, operations);
    };
    bool rose = raise(limits.fma_flops, 2.0 * rate("fma_rate", kFmaChains));
    rose |= raise(limits.lane_instructions_per_s, limits.fma_flops / 2.0);
    rose |=
        raise(limits.lane_instructions_per_s, rate("instruction_rate", kFmaChains + kAddChains));
    rose |= raise(limits.rsqrt_per_s, rate("rsqrt_rate", kFmaChains));
    rose |= raise(limits.sqrt_per_s, rate("sqrt_rate", kFmaChains));
    rose |= raise(limits.divisions_per_s, rate("division_rate", kFmaChains));
    rose |= raise(limits.texels_per_s, kernels.texels_per_s());
    return rose;
}

DeviceLimits measure_device_limits(const Gpu& gpu) {
    return in_stage("measure_limits", [&] {
        const DeviceInfo info = describe(gpu.device);
        const Gpu natural = gpu.with_lanes(info.vector_width);
        const Gpu one_lane = gpu.with_lanes(1);
        LimitKernels kernels(natural);
        DeviceLimits limits;
        limits.lanes = info.vector_width;
        settle_arithmetic_limits(limits, kernels);
        limits.one_lane_fma_flops =
            info.vector_width == 1
                ? limits.fma_flops
                : 2.0 * LimitKernels(one_lane).lane_operations_per_s("fma_rate", kFmaChains);
        limits.cache_bytes = static_cast<double>(std::max(info.cache_bytes, kSmallestCache));
        const MemoryRates large = kernels.memory_rates(large_buffer_bytes(info));
        limits.read_bandwidth = large.read;
        limits.write_bandwidth = large.write;
        limits.copy_bandwidth = large.copy;
        const MemoryRates small = kernels.memory_rates(cached_buffer_bytes(info));
        // A cache is at least as fast as the memory behind it; a disturbed run may say otherwise.
        limits.cached_read_bandwidth = std::max(small.read, large.read);
        limits.cached_write_bandwidth = std::max(small.write, large.write);
        limits.cached_copy_bandwidth = std::max(small.copy, large.copy);
        kernels.measure_transfers(limits);
        // Measures once more, after the clock rates have risen.
        raise_arithmetic_limits(limits, kernels);
        kernels.measure_launch(limits);
        return limits;
    });
}

void keep_device_limits(const DeviceInfo& device, const DeviceLimits& limits) {
    try {
        write_device_cache(device, kKind, values_of(limits));
    } catch (const Error& error) {
        warn(fmt::format("{}; the device's limits will be measured again", error.what()));
    }
}

DeviceLimits cached_device_limits(const Gpu& gpu, bool measure_again) {
    const DeviceInfo info = describe(gpu.device);
    if (!measure_again) {
        if (const auto values = read_device_cache(info, kKind)) {
            if (const auto limits = limits_of(*values, info.vector_width)) return *limits;
        }
    }
    const DeviceLimits limits = measure_device_limits(gpu);
    keep_device_limits(info, limits);
    return limits;
}

void settle_arithmetic_limits(DeviceLimits& limits, LimitKernels& kernels) {
    constexpr int kQuietRounds = 3;
    constexpr std::chrono::seconds kBudget(3);
    const auto start = std::chrono::steady_clock::now();
    int quiet = 0;
    while (quiet < kQuietRounds && std::chrono::steady_clock::now() - start < kBudget) {
        quiet = raise_arithmetic_limits(limits, kernels) ? 0 : quiet + 1;
    }
}

}  // namespace kilolux
