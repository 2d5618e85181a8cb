// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <fstream>

#include "host/base/error.h"
#include "host/gpu/tuning/device_cache.h"
#include "host/measure/roofline/device_limits.h"
#include "host/measure/roofline/independent_limits.h"
#include "host/measure/roofline/limit_watch.h"
#include "tests/support/cache_sandbox.h"

namespace kilolux {
namespace {

constexpr CacheKind kLimitsKind = {"limits", 4};

class DeviceLimitsTest : public CacheSandbox {
 protected:
    DeviceLimitsTest() : gpu_(choose_device("")) {}
    Gpu gpu_;
};

// Of a CPU with so many compute units.
void expect_plausible(const DeviceLimits& l, int compute_units) {
    for (const LimitField& field : limit_fields()) {
        const double value = l.*field.value;
        EXPECT_TRUE(std::isfinite(value) && value > 0.0) << field.name << ": " << value;
    }
    // No core exceeds 6 GHz, four vector instructions a cycle, and a vector moved by each.
    const double lanes_per_s = 6e9 * 4.0 * l.lanes * compute_units;
    EXPECT_LT(l.lane_instructions_per_s, lanes_per_s);
    EXPECT_LT(std::max(l.fma_flops, l.one_lane_fma_flops), 2.0 * lanes_per_s);
    for (const double bandwidth :
         {l.read_bandwidth, l.write_bandwidth, l.copy_bandwidth, l.cached_read_bandwidth,
          l.cached_write_bandwidth, l.cached_copy_bandwidth, l.upload_bandwidth,
          l.download_bandwidth}) {
        EXPECT_LT(bandwidth, 4.0 * lanes_per_s);
    }
    EXPECT_LT(std::max(l.launch_latency_ms, l.launch_event_ms), 1000.0);
    // A special function takes a vector instruction at least.
    EXPECT_LT(l.rsqrt_per_s, l.lane_instructions_per_s);
    EXPECT_LT(l.divisions_per_s, l.lane_instructions_per_s);
    EXPECT_LT(l.texels_per_s, l.lane_instructions_per_s);
}

TEST_F(DeviceLimitsTest, ArePlausibleAndOfTheVectorUnit) {
    const DeviceLimits limits = measure_device_limits(gpu_);
    expect_plausible(limits, gpu_.info.compute_units);
    EXPECT_EQ(limits.lanes, describe(gpu_.device).vector_width);
}

TEST_F(DeviceLimitsTest, DoNotDependOnTheLanesThatTheCallerShadesWith) {
    const Gpu one_lane = gpu_.with_lanes(1);
    EXPECT_EQ(measure_device_limits(one_lane).lanes, describe(gpu_.device).vector_width);
}

TEST_F(DeviceLimitsTest, AreMeasuredOnceAndKept) {
    const DeviceLimits first = cached_device_limits(gpu_);
    EXPECT_EQ(cached_device_limits(gpu_), first);
    // A changed entry is read back unchanged: limits are not measured again.
    auto values = read_device_cache(gpu_.info, kLimitsKind);
    ASSERT_TRUE(values);
    (*values)["fma_flops"] = 12345.0;
    write_device_cache(gpu_.info, kLimitsKind, *values);
    EXPECT_EQ(cached_device_limits(gpu_).fma_flops, 12345.0);
    const DeviceLimits again = cached_device_limits(gpu_, true);
    EXPECT_NE(again.fma_flops, 12345.0);
    EXPECT_EQ(cached_device_limits(gpu_), again);
}

TEST_F(DeviceLimitsTest, AreMeasuredAgainWhenAnEntryCannotBeTrue) {
    auto values = CacheValues{{"lanes", describe(gpu_.device).vector_width}, {"fma_flops", 1.0}};
    write_device_cache(gpu_.info, kLimitsKind, values);  // incomplete
    expect_plausible(cached_device_limits(gpu_), gpu_.info.compute_units);
    values = *read_device_cache(gpu_.info, kLimitsKind);
    values["read_bytes_per_s"] = 0.0;  // would make every limit infinite
    write_device_cache(gpu_.info, kLimitsKind, values);
    expect_plausible(cached_device_limits(gpu_), gpu_.info.compute_units);
    std::ofstream(device_cache_file(gpu_.info, kLimitsKind)) << "damaged";
    expect_plausible(cached_device_limits(gpu_), gpu_.info.compute_units);
}

TEST_F(DeviceLimitsTest, RiseWhileABenchmarkWatchesAndNeverFall) {
    const DeviceLimits measured = cached_device_limits(gpu_);
    auto values = *read_device_cache(gpu_.info, kLimitsKind);
    values["sqrt_per_s"] = 1.0;         // as on a busy machine
    values["divisions_per_s"] = 1e300;  // no measurement reaches that
    write_device_cache(gpu_.info, kLimitsKind, values);
    LimitWatch watch(gpu_.device);
    EXPECT_GT(watch.limits().sqrt_per_s, 1e-3 * measured.sqrt_per_s);
    EXPECT_EQ(watch.limits().divisions_per_s, 1e300);
    EXPECT_EQ(watch.limits().read_bandwidth, measured.read_bandwidth);
    EXPECT_EQ(cached_device_limits(gpu_), watch.limits()) << "not kept";
    const DeviceLimits before = watch.limits();
    watch.look_again();
    EXPECT_GE(watch.limits().sqrt_per_s, before.sqrt_per_s);
    EXPECT_EQ(watch.limits().divisions_per_s, 1e300);
}

TEST_F(DeviceLimitsTest, WorkWithoutACacheFolder) {
    std::ofstream(folder() / "file") << "";
    set("XDG_CACHE_HOME", (folder() / "file").c_str());
    testing::internal::CaptureStderr();
    const DeviceLimits limits = cached_device_limits(gpu_);
    const std::string warning = testing::internal::GetCapturedStderr();
    expect_plausible(limits, gpu_.info.compute_units);
    EXPECT_NE(warning.find("measured again"), std::string::npos) << warning;
}

TEST(PublishedLimits, AreThoseOfTheDeviceAndNotOfOneWithALongerName) {
    const auto peak = [](const char* name) {
        DeviceInfo device;
        device.name = name;
        return check_limits(device, DeviceLimits{}).front().independent;
    };
    EXPECT_EQ(peak("NVIDIA L4"), 30.3e12);
    EXPECT_EQ(peak("NVIDIA L40S"), 91.6e12);
    EXPECT_EQ(peak("NVIDIA H100 80GB HBM3"), 67e12);
    for (const char* unknown : {"NVIDIA L40", "NVIDIA T400", "Quadro RTX 40900"})
        EXPECT_THROW(peak(unknown), Error) << unknown;
}

TEST(BufferSizes, FitWhatTheDeviceHas) {
    DeviceInfo device;
    for (const std::uint64_t cache :
         {std::uint64_t{0}, std::uint64_t{32} << 20, std::uint64_t{1} << 30}) {
        for (const std::uint64_t memory : {std::uint64_t{256} << 20, std::uint64_t{64} << 30}) {
            device.cache_bytes = cache;
            device.memory_bytes = memory;
            device.max_allocation_bytes = memory / 4;
            const std::uint64_t bytes = large_buffer_bytes(device);
            EXPECT_LE(2 * bytes, memory / 8) << cache << " " << memory;
            EXPECT_GT(bytes, 0u);
            const std::uint64_t small = cached_buffer_bytes(device);
            EXPECT_LE(2 * small, std::max(cache, kSmallestCache)) << cache;
        }
    }
    device.cache_bytes = 32 << 20;
    EXPECT_EQ(large_buffer_bytes(device), std::uint64_t{128} << 20);
    EXPECT_EQ(cached_buffer_bytes(device), std::uint64_t{8} << 20);
}

}  // namespace
}  // namespace kilolux
