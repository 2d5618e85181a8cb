// SPDX-License-Identifier: Apache-2.0
// Probes: kernels that call a shared function for each element of arrays.
#pragma once

#include <numeric>

#include "host/certify/synthetic/probe.h"
#include "host/gpu/buffer.h"

namespace kilolux {

/// A kernel of build_probe(). Where `headers` have lanes, `text` may call probe_vector() and
/// put_probe_vector() of probe.cpp.
struct Probe {
    std::span<const std::string_view> headers;
    std::string_view text;
    const char* kernel = "probe";
    BuildOptions options{};
};

template <typename T>
T probe_argument(const Gpu&, const T& value) {
    return value;
}
template <typename T>
cl::Buffer probe_argument(const Gpu& gpu, const std::vector<T>& values) {
    return new_buffer(gpu, values);
}

/// Runs a probe with one work-item for each vector of `elements`, and returns the `count` values of
/// the buffer that is its last parameter. Vectors among the other arguments are uploaded.
template <typename T, typename... Arguments>
std::vector<T> run_probe(Gpu gpu, const Probe& probe, std::size_t elements, std::size_t count,
                         const Arguments&... arguments) {
    constexpr T kUnwritten = 77777;  // no probe's result
    const cl::Program program = build_probe(gpu, probe.headers, probe.text, probe.options);
    const cl::Buffer out = new_buffer(gpu, std::vector<T>(count, kUnwritten));
    const std::size_t items = elements / static_cast<std::size_t>(gpu.info.lane_width);
    // PoCL has the private memory of a whole group on a thread's stack.
    const std::size_t group = std::gcd(items, std::size_t{16});
    cl::KernelFunctor<decltype(probe_argument(gpu, arguments))..., cl::Buffer>(
        program, probe.kernel)(cl::EnqueueArgs(gpu.queue, cl::NDRange(items), cl::NDRange(group)),
                               probe_argument(gpu, arguments)..., out);
    return download<T>(gpu, out, count);
}

}  // namespace kilolux
