// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/buffer.h"

#include <algorithm>

#include "host/base/system/memory.h"
#include "host/gpu/program.h"

namespace kilolux {

// Why the device or the budget cannot give `bytes` in place of the buffer; empty if they can.
std::string GrowingBuffer::refusal(std::size_t bytes) const {
    if (bytes > gpu_.info.max_allocation_bytes) {
        return owner_ + ": needs a buffer of " + mebibytes(bytes) + "; " + gpu_.info.name +
               " allocates at most " + mebibytes(gpu_.info.max_allocation_bytes) + " at once";
    }
    if (!gpu_.budget) return {};
    const std::uint64_t released = charge_.use_count() == 1 ? charge_->bytes() : 0;
    const std::uint64_t others = gpu_.budget->used - released, limit = gpu_.budget->limit;
    const std::uint64_t left = limit - std::min(limit, others);
    if (bytes <= left) return {};
    return owner_ + ": " + shortage_text(bytes, "device buffers", left, limit);
}

void GrowingBuffer::allocate(std::size_t bytes) {
    buffer_ = cl::Buffer();  // before the new one is made: both might not fit
    bytes_ = 0;
    charge_.reset();
    try {
        buffer_ = cl::Buffer(gpu_.context, CL_MEM_READ_WRITE, bytes);
    } catch (const cl::Error& error) {
        throw Error(owner_ + ": needs a buffer of " + mebibytes(bytes) +
                    "; allocation failed with " + cl_error_name(error.err()));
    }
    bytes_ = bytes;
    if (gpu_.budget) charge_ = std::make_shared<BufferCharge>(gpu_.budget, bytes);
}

const cl::Buffer& GrowingBuffer::reserve(std::size_t bytes, std::size_t slack) {
    bytes = std::max<std::size_t>(bytes, 16);
    if (bytes <= bytes_) return buffer_;
    if (slack > 0 && refusal(bytes + slack).empty()) {
        try {
            allocate(bytes + slack);
            return buffer_;
        } catch (const Error&) {  // retry without slack
        }
    }
    if (const std::string why = refusal(bytes); !why.empty()) throw Error(why);
    allocate(bytes);
    return buffer_;
}

std::vector<uint> download_indices(const Gpu& gpu, const cl::Buffer& list, int bits,
                                   std::size_t count, std::size_t first) {
    if (bits == 32) return download<uint>(gpu, list, count, first);
    const auto narrow = download<std::uint16_t>(gpu, list, count, first);
    return {narrow.begin(), narrow.end()};
}

}  // namespace kilolux
