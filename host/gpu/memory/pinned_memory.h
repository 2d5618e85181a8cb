// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "host/gpu/device.h"

namespace kilolux {

/// Host memory that a device copies to at the full rate of its bus: a driver stages copies to other
/// memory, at a tenth of it on a discrete GPU. It grows on demand.
class PinnedMemory {
 public:
    explicit PinnedMemory(const Gpu& gpu) : gpu_(gpu) {}
    ~PinnedMemory() { release(); }
    PinnedMemory(const PinnedMemory&) = delete;
    PinnedMemory& operator=(const PinnedMemory&) = delete;

    /// At least `bytes`; what was there before is lost. Throws cl::Error when the driver refuses.
    std::byte* reserve(std::size_t bytes);

    /// What reserve() returned last; null before.
    template <typename T>
    T* data() const {
        return reinterpret_cast<T*>(mapping_);
    }

 private:
    void release() noexcept;

    Gpu gpu_;
    cl::Buffer buffer_;
    std::byte* mapping_ = nullptr;
    std::size_t bytes_ = 0;
};

}  // namespace kilolux
