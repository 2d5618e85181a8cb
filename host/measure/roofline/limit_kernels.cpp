// SPDX-License-Identifier: Apache-2.0
#include "host/measure/roofline/limit_kernels.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "host/gpu/features.h"

namespace kilolux {
namespace {

constexpr int kMostLanes = 16;

using Clock = std::chrono::steady_clock;

// Long compared with an empty launch.
constexpr double kRunSeconds = 0.004;
constexpr int kRuns = 5;
// A rate's measurement ends after this, also on slow devices.
constexpr double kBudgetSeconds = 0.05;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

double event_seconds(const cl::Event& event) {
    event.wait();
    const auto start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
    const auto end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
    // At least one clock tick, so that a rate stays finite.
    return 1e-9 * static_cast<double>(std::max<cl_ulong>(end - start, 1));
}

// Work per second of run(n), which does n * unit and returns its seconds. n grows until a run is
// long enough; then the best of several counts.
template <typename Run>
double best_rate(double unit, uint most, Run run) {
    const Clock::time_point start = Clock::now();
    uint n = 1;
    double seconds = run(n);
    while (seconds < kRunSeconds && n < most) {
        const double factor = std::clamp(1.2 * kRunSeconds / seconds, 2.0, 64.0);
        n = static_cast<uint>(std::min(factor * n, static_cast<double>(most)));
        seconds = run(n);
    }
    for (int i = 1; i < kRuns && seconds_since(start) < kBudgetSeconds; ++i) {
        seconds = std::min(seconds, run(n));
    }
    return unit * n / seconds;
}

KernelProgram texel_program(const Gpu& gpu) {
    return build_program(gpu, "measure_texels", BuildOptions().define("TEXELS", kTexels));
}

}  // namespace

std::uint64_t large_buffer_bytes(const DeviceInfo& device) {
    constexpr std::uint64_t kSmallest = 64 << 20, kLargest = 512 << 20;
    const std::uint64_t wanted = std::clamp(4 * device.cache_bytes, kSmallest, kLargest);
    // Two of them leave most of the memory to other programs.
    const std::uint64_t room = std::min(device.max_allocation_bytes, device.memory_bytes / 16);
    return std::max(std::min(wanted, room), kSmallestCache);
}

std::uint64_t cached_buffer_bytes(const DeviceInfo& device) {
    const std::uint64_t cache = std::max(device.cache_bytes, kSmallestCache);
    return std::clamp<std::uint64_t>(cache / 4, 64 << 10, 8 << 20);
}

LimitKernels::LimitKernels(const Gpu& gpu)
    : gpu_(gpu),
      program_(build_program(gpu, "measure_limits")),
      group_(gpu.info.is_cpu ? 1 : static_cast<std::size_t>(fitting_group(256, gpu.info))),
      // Four pieces a CPU thread balance late starts; GPUs need many to hide latency.
      items_(static_cast<std::size_t>(gpu.info.compute_units) *
             (gpu.info.is_cpu ? 4 : 16 * group_)),
      walkers_(gpu.info.is_cpu ? static_cast<std::size_t>(gpu.info.compute_units) : items_),
      out_(gpu.context, CL_MEM_READ_WRITE, items_ * kMostLanes * sizeof(float)),
      texels_(gpu.context, CL_MEM_READ_WRITE, kTexels * sizeof(cl_ulong)) {
    gpu.queue.enqueueFillBuffer<cl_ulong>(texels_, 1, 0, kTexels * sizeof(cl_ulong));
    widths_.push_back({gpu.info.lane_width, program_, texel_program(gpu)});
    const int twice = 2 * gpu.info.lane_width;
    const bool is_own_width = gpu.info.lane_width == describe(gpu.device).lane_width;
    if (!gpu.info.is_cpu || !is_own_width || twice > kMostLanes) return;
    const Gpu wide(gpu.context, gpu.queue, twice);
    widths_.push_back({twice, build_program(wide, "measure_limits"), texel_program(wide)});
}

double LimitKernels::lane_operations_per_s(const char* kernel, int operations) {
    // Numbers stay near 1: fma(x, a, b) converges to b / (1 - a) = 1; a / x alternates about
    // sqrt(a).
    constexpr float kA = 0.75f, kB = 0.25f;
    const cl::EnqueueArgs items(gpu_.queue, cl::NDRange(items_), cl::NDRange(group_));
    double best = 0.0;
    for (const Width& width : widths_) {
        cl::KernelFunctor<uint, float, float, cl::Buffer> run(width.program.built(), kernel);
        const double unit = static_cast<double>(items_) * width.lanes * operations;
        best = std::max(best, best_rate(unit, 1u << 30, [&](uint n) {
                            return event_seconds(run(items, n, kA, kB, out_));
                        }));
    }
    return best;
}

double LimitKernels::texels_per_s() {
    const cl::EnqueueArgs items(gpu_.queue, cl::NDRange(items_), cl::NDRange(group_));
    double best = 0.0;
    for (const Width& width : widths_) {
        cl::KernelFunctor<uint, cl::Buffer, cl::Buffer> run(width.texels.built(), "texel_rate");
        const double unit = static_cast<double>(items_) * width.lanes * kTexelChains;
        best = std::max(best, best_rate(unit, 1u << 30, [&](uint n) {
                            return event_seconds(run(items, n, texels_, out_));
                        }));
    }
    return best;
}

// How work-items share the buffers; see kernels/limits/measure_limits.cl.
struct LimitKernels::Walk {
    uint count, item_step, step;
    cl::Buffer to, from;
    double bytes_per_repeat;
};

double LimitKernels::walk_bytes_per_s(const char* kernel, const Walk& walk) {
    cl::KernelFunctor<uint, uint, uint, uint, cl::Buffer, cl::Buffer, cl::Buffer> run(
        program_.built(), kernel);
    const cl::EnqueueArgs items(gpu_.queue, cl::NDRange(walkers_), cl::NDRange(group_));
    return best_rate(walk.bytes_per_repeat, 1u << 20, [&](uint repeats) {
        return event_seconds(
            run(items, repeats, walk.count, walk.item_step, walk.step, walk.to, walk.from, out_));
    });
}

MemoryRates LimitKernels::memory_rates(std::uint64_t bytes) {
    const std::uint64_t vector_bytes =
        sizeof(float) * static_cast<std::uint64_t>(gpu_.info.lane_width);
    Walk walk;
    walk.count =
        static_cast<uint>(std::max<std::uint64_t>(bytes / vector_bytes / walkers_ / 4 * 4, 4));
    walk.item_step = gpu_.info.is_cpu ? walk.count : 1;
    walk.step = gpu_.info.is_cpu ? 1 : static_cast<uint>(walkers_);
    const std::size_t used = std::size_t{walk.count} * walkers_ * vector_bytes;
    walk.to = cl::Buffer(gpu_.context, CL_MEM_READ_WRITE, used);
    walk.from = cl::Buffer(gpu_.context, CL_MEM_READ_WRITE, used);
    gpu_.queue.enqueueFillBuffer(walk.to, 1.0f, 0, used);
    gpu_.queue.enqueueFillBuffer(walk.from, 1.0f, 0, used);
    gpu_.queue.finish();
    MemoryRates rates;
    walk.bytes_per_repeat = static_cast<double>(used);
    rates.read = walk_bytes_per_s("read_memory", walk);
    rates.write = walk_bytes_per_s("write_memory", walk);
    walk.bytes_per_repeat *= 2.0;
    rates.copy = walk_bytes_per_s("copy_memory", walk);
    return rates;
}

void LimitKernels::measure_transfers(DeviceLimits& limits) {
    constexpr std::size_t kBytes = 16 << 20;
    std::vector<char> memory(kBytes, 1);
    const cl::Buffer buffer(gpu_.context, CL_MEM_READ_WRITE, kBytes);
    const auto rate = [&](const auto& transfer) {
        return best_rate(static_cast<double>(kBytes), 1, [&](uint) {
            const Clock::time_point start = Clock::now();
            transfer();
            return seconds_since(start);
        });
    };
    limits.upload_bandwidth =
        rate([&] { gpu_.queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, kBytes, memory.data()); });
    limits.download_bandwidth =
        rate([&] { gpu_.queue.enqueueReadBuffer(buffer, CL_TRUE, 0, kBytes, memory.data()); });
}

void LimitKernels::measure_launch(DeviceLimits& limits) {
    constexpr int kLaunches = 200;
    cl::KernelFunctor<cl::Buffer> nothing(program_.built(), "launch_nothing");
    const cl::EnqueueArgs one(gpu_.queue, cl::NDRange(group_), cl::NDRange(group_));
    limits.launch_latency_ms = limits.launch_event_ms = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kLaunches; ++i) {
        const Clock::time_point start = Clock::now();
        const cl::Event event = nothing(one, out_);
        gpu_.queue.finish();
        limits.launch_latency_ms = std::min(limits.launch_latency_ms, 1e3 * seconds_since(start));
        limits.launch_event_ms = std::min(limits.launch_event_ms, 1e3 * event_seconds(event));
    }
}

}  // namespace kilolux
