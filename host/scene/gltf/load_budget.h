// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "host/base/error.h"

namespace kilolux {

/// Less memory is left than something needs.
class MemoryError : public Error {
 public:
    using Error::Error;
};

class LoadBudget;
struct ReleaseMemory {
    std::uint64_t bytes = 0;
    void operator()(LoadBudget* budget) const;
};

/// Memory that returns to its budget when this is destroyed.
using MemoryCharge = std::unique_ptr<LoadBudget, ReleaseMemory>;

/// Memory that loading a file may still allocate. Safe to charge from several threads.
class LoadBudget {
 public:
    /// All that the scene keeps in memory is bounded by `memory_bytes`.
    explicit LoadBudget(std::uint64_t memory_bytes);

    /// Bounds what charge() takes by the size of the file's JSON and buffers, so that a small
    /// broken file cannot claim all memory.
    void allow_for_file(std::uint64_t file_bytes);

    /// Takes count * bytes_each for what accessors decode to. Throws Error that starts with
    /// "<where>: " when that is more than the file's size allows, MemoryError when it is more than
    /// the memory allows.
    void charge(std::uint64_t count, std::uint64_t bytes_each, const std::string& where);

    /// Takes bytes for a buffer or an image, which only the memory bounds.
    void charge_memory(std::uint64_t bytes, const std::string& where);

    /// The same until the charge is destroyed.
    MemoryCharge borrow_memory(std::uint64_t bytes, const std::string& where);

    /// Gives back what charge_memory() took.
    void release_memory(std::uint64_t bytes) { memory_left_ += bytes; }

    /// Gives back what charge() took: later decoding replaces the earlier results.
    void refill();

 private:
    std::uint64_t memory_limit_;
    std::atomic<std::uint64_t> memory_left_;
    std::uint64_t decode_limit_ = 0;
    std::atomic<std::uint64_t> decode_left_ = 0;
};

}  // namespace kilolux
