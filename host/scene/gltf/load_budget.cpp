// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/load_budget.h"

#include <fmt/core.h>

#include "host/base/system/memory.h"

namespace kilolux {
namespace {

// Bounds of the memory that accessors decode to: enough for real files with instanced, skinned and
// compressed meshes, small enough that a file of a few KiB cannot claim gigabytes.
constexpr std::uint64_t kBudgetFloorBytes = std::uint64_t{256} << 20;
constexpr std::uint64_t kBudgetPerFileByte = 1024;

// Takes bytes from a budget shared with other threads; false when fewer are left.
bool take(std::atomic<std::uint64_t>& left, std::uint64_t bytes) {
    std::uint64_t seen = left.load();
    do {
        if (bytes > seen) return false;
    } while (!left.compare_exchange_weak(seen, seen - bytes));
    return true;
}

}  // namespace

LoadBudget::LoadBudget(std::uint64_t memory_bytes)
    : memory_limit_(memory_bytes), memory_left_(memory_bytes) {}

void LoadBudget::allow_for_file(std::uint64_t file_bytes) {
    decode_left_ = decode_limit_ = kBudgetFloorBytes + kBudgetPerFileByte * file_bytes;
}

void LoadBudget::charge(std::uint64_t count, std::uint64_t bytes_each, const std::string& where) {
    const bool overflows = bytes_each != 0 && count > decode_limit_ / bytes_each;
    if (overflows || !take(decode_left_, count * bytes_each)) {
        throw Error(
            fmt::format("{}: claims {} elements of {} bytes, more than a file of this size "
                        "may decode to ({})",
                        where, count, bytes_each, mebibytes(decode_limit_)));
    }
    charge_memory(count * bytes_each, where);
}

void LoadBudget::charge_memory(std::uint64_t bytes, const std::string& where) {
    if (take(memory_left_, bytes)) return;
    throw MemoryError(
        where + ": " +
        shortage_text(bytes, "memory for buffers, images and meshes", memory_left_, memory_limit_));
}

MemoryCharge LoadBudget::borrow_memory(std::uint64_t bytes, const std::string& where) {
    charge_memory(bytes, where);
    return MemoryCharge(this, ReleaseMemory{bytes});
}

void ReleaseMemory::operator()(LoadBudget* budget) const { budget->release_memory(bytes); }

void LoadBudget::refill() {
    memory_left_ += decode_limit_ - decode_left_;
    decode_left_ = decode_limit_;
}

}  // namespace kilolux
