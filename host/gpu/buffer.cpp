// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/buffer.h"

#include <algorithm>

#include "host/gpu/program.h"

namespace kilolux {

const cl::Buffer& GrowingBuffer::reserve(std::size_t bytes) {
    bytes = std::max<std::size_t>(bytes, 16);
    if (bytes <= bytes_) return buffer_;
    const auto need = [&] { return owner_ + ": needs a buffer of " + std::to_string(bytes >> 20) + " MiB; "; };
    if (bytes > gpu_.info.max_allocation_bytes) {
        throw Error(need() + gpu_.info.name + " allocates at most " + std::to_string(gpu_.info.max_allocation_bytes >> 20) + " MiB at once");
    }
    try {
        buffer_ = cl::Buffer();  // before the new one is there: both might not fit
        counted_.reset();
        bytes_ = 0;
        buffer_ = cl::Buffer(gpu_.context, CL_MEM_READ_WRITE, bytes);
        bytes_ = bytes;
        *gpu_.allocated_bytes += bytes;
        counted_ = std::shared_ptr<void>(nullptr, [total = gpu_.allocated_bytes, bytes](void*) { *total -= bytes; });
    } catch (const cl::Error& error) {
        throw Error(need() + "allocation failed with " + cl_error_name(error.err()));
    }
    return buffer_;
}

}  // namespace kilolux
