// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>
#include <string_view>
#include <vector>

#include "host/gpu/device.h"
#include "host/gpu/program.h"

namespace kilolux {

/// A program of `headers` (embedded, spliced) followed by `text`, built as the stages are: for
/// running a shared function on the device. Throws Error with the compiler's log.
KernelProgram build_probe(const Gpu& gpu, std::span<const std::string_view> headers,
                          std::string_view text, const BuildOptions& options = {});

/// Uploads `values` to a new buffer of at least 16 bytes.
template <typename T>
cl::Buffer new_buffer(const Gpu& gpu, const std::vector<T>& values) {
    const std::size_t bytes = std::max<std::size_t>(values.size() * sizeof(T), 16);
    cl::Buffer buffer(gpu.context, CL_MEM_READ_WRITE, bytes);
    if (!values.empty()) {
        gpu.queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(T), values.data());
    }
    return buffer;
}

}  // namespace kilolux
