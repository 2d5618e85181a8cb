// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/buffer.h"

#include <algorithm>

#include "host/base/memory.h"
#include "host/gpu/program.h"

namespace kilolux {

void GrowingBuffer::check(std::size_t bytes) const {
    const std::string need = owner_ + ": needs a buffer of " + mebibytes(bytes) + "; ";
    if (bytes > gpu_.info.max_allocation_bytes) {
        throw Error(need + gpu_.info.name + " allocates at most " +
                    mebibytes(gpu_.info.max_allocation_bytes) + " at once");
    }
    if (!gpu_.budget) return;
    const std::uint64_t others = gpu_.budget->used - charge_.bytes();
    if (bytes > gpu_.budget->limit || others > gpu_.budget->limit - bytes) {
        throw Error(need + mebibytes(others) + " of the " + mebibytes(gpu_.budget->limit) +
                    " for device buffers are taken (--max-memory)");
    }
}

const cl::Buffer& GrowingBuffer::reserve(std::size_t bytes) {
    bytes = std::max<std::size_t>(bytes, 16);
    if (bytes <= bytes_) return buffer_;
    check(bytes);
    try {
        buffer_ = cl::Buffer();  // before the new one is there: both might not fit
        bytes_ = 0;
        charge_ = BufferCharge(gpu_.budget, 0);
        buffer_ = cl::Buffer(gpu_.context, CL_MEM_READ_WRITE, bytes);
        bytes_ = bytes;
        charge_ = BufferCharge(gpu_.budget, bytes);
    } catch (const cl::Error& error) {
        throw Error(owner_ + ": needs a buffer of " + mebibytes(bytes) +
                    "; allocation failed with " + cl_error_name(error.err()));
    }
    return buffer_;
}

}  // namespace kilolux
