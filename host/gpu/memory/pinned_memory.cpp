// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/memory/pinned_memory.h"

namespace kilolux {

std::byte* PinnedMemory::reserve(std::size_t bytes) {
    if (bytes <= bytes_) return mapping_;
    release();
    buffer_ = cl::Buffer(gpu_.context, CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR, bytes);
    mapping_ = static_cast<std::byte*>(
        gpu_.queue.enqueueMapBuffer(buffer_, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0, bytes));
    bytes_ = bytes;
    return mapping_;
}

void PinnedMemory::release() noexcept {
    if (mapping_ != nullptr) {
        clEnqueueUnmapMemObject(gpu_.queue(), buffer_(), mapping_, 0, nullptr, nullptr);
        clFinish(gpu_.queue());
    }
    mapping_ = nullptr;
    bytes_ = 0;
    buffer_ = cl::Buffer();
}

}  // namespace kilolux
