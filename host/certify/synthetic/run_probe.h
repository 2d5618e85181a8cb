// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numeric>

#include "host/certify/synthetic/probe.h"
#include "host/gpu/buffer.h"

namespace kilolux {

/// A kernel "probe" for build_probe().
struct Probe {
    std::span<const std::string_view> headers;
    std::string_view text;
    BuildOptions options{};
};

inline std::size_t lanes_of(const Gpu& gpu) {
    return static_cast<std::size_t>(gpu.info.lane_width);
}

/// A vector as a buffer, other values as they are.
template <typename T>
auto probe_argument(const Gpu& gpu, const T& value) {
    if constexpr (requires { value.data(); }) return new_buffer(gpu, value);
    if constexpr (!requires { value.data(); }) return value;
}

/// What so many work-items of a probe write into its last parameter, a buffer of `count` values.
template <typename T, typename... Arguments>
std::vector<T> run_probe(Gpu gpu, const Probe& probe, std::size_t items, std::size_t count,
                         const Arguments&... arguments) {
    constexpr T kUnwritten = 77777;  // no probe's result
    const cl::Program program = build_probe(gpu, probe.headers, probe.text, probe.options).built();
    const cl::Buffer out = new_buffer(gpu, std::vector<T>(count, kUnwritten));
    // PoCL has the private memory of a whole group on a thread's stack.
    const cl::NDRange group(std::gcd(items, std::size_t{16}));
    cl::KernelFunctor<decltype(probe_argument(gpu, arguments))..., cl::Buffer>(program, "probe")(
        cl::EnqueueArgs(gpu.queue, cl::NDRange(items), group), probe_argument(gpu, arguments)...,
        out);
    return download<T>(gpu, out, count);
}

}  // namespace kilolux
