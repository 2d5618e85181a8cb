// SPDX-License-Identifier: Apache-2.0
#include "host/measure/roofline/independent_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <functional>
#include <thread>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "host/base/error.h"
#include "host/measure/roofline/limit_kernels.h"

namespace kilolux {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kChains = 12;  // hide the latency of two units of 4 to 6 cycles
constexpr std::size_t kFmas = 20'000'000;
volatile float result_sink;  // keeps the compiler from dropping the loops

// kFmas multiply-adds of each chain, with as many lanes as the name says.
#if defined(__x86_64__)
[[gnu::target("avx512f")]] void fma_16() {
    __m512 x[kChains];
    const __m512 a = _mm512_set1_ps(0.75f), b = _mm512_set1_ps(0.25f);
    for (int i = 0; i < kChains; ++i) x[i] = _mm512_set1_ps(static_cast<float>(i));
    for (std::size_t n = 0; n < kFmas / 16; ++n) {
        for (__m512& chain : x) chain = _mm512_fmadd_ps(chain, a, b);
    }
    for (int i = 1; i < kChains; ++i) x[0] = _mm512_add_ps(x[0], x[i]);
    result_sink = _mm512_cvtss_f32(x[0]);
}

[[gnu::target("avx2,fma")]] void fma_8() {
    __m256 x[kChains];
    const __m256 a = _mm256_set1_ps(0.75f), b = _mm256_set1_ps(0.25f);
    for (int i = 0; i < kChains; ++i) x[i] = _mm256_set1_ps(static_cast<float>(i));
    for (std::size_t n = 0; n < kFmas / 8; ++n) {
        for (__m256& chain : x) chain = _mm256_fmadd_ps(chain, a, b);
    }
    for (int i = 1; i < kChains; ++i) x[0] = _mm256_add_ps(x[0], x[i]);
    result_sink = _mm256_cvtss_f32(x[0]);
}
#endif

void fma_1() {
    float x[kChains];
    for (int i = 0; i < kChains; ++i) x[i] = static_cast<float>(i);
    for (std::size_t n = 0; n < kFmas; ++n) {
        for (float& chain : x) chain = std::fma(chain, 0.75f, 0.25f);
    }
    for (int i = 1; i < kChains; ++i) x[0] += x[i];
    result_sink = x[0];
}

void widest_fma() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f")) return fma_16();
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return fma_8();
#endif
    return fma_1();
}

// Runs `work` in as many threads, several times; the least time of all of them together [s].
double best_seconds(int threads, const std::function<void(int thread)>& work) {
    constexpr int kRuns = 5;
    double best = INFINITY;
    for (int run = 0; run < kRuns; ++run) {
        const Clock::time_point start = Clock::now();
        std::vector<std::jthread> running;
        for (int i = 0; i < threads; ++i) running.emplace_back(work, i);
        running.clear();
        best = std::min(best, std::chrono::duration<double>(Clock::now() - start).count());
    }
    return best;
}

double fma_flops(int threads) {
    const double fmas = static_cast<double>(kFmas) * kChains * threads;
    return 2.0 * fmas / best_seconds(threads, [](int) { widest_fma(); });
}

// Walks a part of two large arrays a thread. GCC's vectors need no intrinsics here: memory is the
// limit, not the instructions.
struct Memory {
    using Vector [[gnu::vector_size(32)]] = float;

    Memory(int thread_count, std::uint64_t bytes)
        : threads(thread_count),
          part(bytes / sizeof(Vector) / static_cast<std::size_t>(thread_count) / 4 * 4),
          from(part * static_cast<std::size_t>(thread_count), Vector{} + 1.0f),
          to(from.size(), Vector{}) {}

    double bytes() const { return static_cast<double>(from.size() * sizeof(Vector)); }

    double read_bandwidth() const {
        return bytes() / best_seconds(threads, [this](int thread) {
                   const Vector* p = from.data() + part * static_cast<std::size_t>(thread);
                   Vector sums[4] = {};
                   for (std::size_t i = 0; i < part; i += 4) {
                       for (std::size_t j = 0; j < 4; ++j) sums[j] += p[i + j];
                   }
                   const Vector sum = sums[0] + sums[1] + sums[2] + sums[3];
                   result_sink = sum[0];
               });
    }

    double copy_bandwidth() {
        return 2.0 * bytes() / best_seconds(threads, [this](int thread) {
                   const std::size_t first = part * static_cast<std::size_t>(thread);
                   for (std::size_t i = 0; i < part; ++i) to[first + i] = from[first + i];
                   result_sink = to[first][0];
               });
    }

    int threads;
    std::size_t part;  // vectors a thread
    std::vector<Vector> from, to;
};

// Vendors' data sheets, without sparsity: single precision [1/s] and memory [byte/s].
struct Published {
    const char* name;  // part of the device's
    double fma_flops;
    double bandwidth;
};
constexpr Published kPublished[] = {{"H200", 67e12, 4.8e12},
                                    {"H100 80GB HBM3", 67e12, 3.35e12},
                                    {"H100 PCIe", 51e12, 2.0e12},
                                    {"A100-SXM4-80GB", 19.5e12, 2.04e12},
                                    {"A100-SXM4-40GB", 19.5e12, 1.56e12},
                                    {"L40S", 91.6e12, 864e9},
                                    {"L4", 30.3e12, 300e9},
                                    {"RTX 4090", 82.6e12, 1008e9},
                                    {"RTX 3090", 35.6e12, 936e9},
                                    {"T4", 8.1e12, 320e9}};

// Whether `words` stand in a device's name and are not the beginning or the end of longer ones:
// "L4" is no part of "NVIDIA L40S".
bool is_named(std::string_view name, std::string_view words) {
    const auto is_word = [&](std::size_t at) {
        return at < name.size() && std::isalnum(static_cast<unsigned char>(name[at])) != 0;
    };
    const std::size_t at = name.find(words);
    return at != std::string_view::npos && (at == 0 || !is_word(at - 1)) &&
           !is_word(at + words.size());
}

std::vector<LimitCheck> against_published(const DeviceInfo& device, const DeviceLimits& limits) {
    for (const Published& peak : kPublished) {
        if (!is_named(device.name, peak.name)) continue;
        return {{"fma_flops", limits.fma_flops, peak.fma_flops},
                {"read_bandwidth", limits.read_bandwidth, peak.bandwidth},
                {"copy_bandwidth", limits.copy_bandwidth, peak.bandwidth}};
    }
    throw Error(fmt::format("{}: its published peaks are not known here", device.name));
}

}  // namespace

std::vector<LimitCheck> check_limits(const DeviceInfo& device, const DeviceLimits& limits) {
    if (!device.is_cpu) return against_published(device, limits);
    Memory memory(device.compute_units, large_buffer_bytes(device));
    return {{"fma_flops", limits.fma_flops, fma_flops(device.compute_units)},
            {"read_bandwidth", limits.read_bandwidth, memory.read_bandwidth()},
            {"copy_bandwidth", limits.copy_bandwidth, memory.copy_bandwidth()}};
}

}  // namespace kilolux
