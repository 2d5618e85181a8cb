// SPDX-License-Identifier: Apache-2.0
#include "host/base/system/memory.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <thread>

#include "host/base/error.h"

namespace kilolux {
namespace {

constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();

// The first number of a file; kUnknown if it holds "max" instead.
std::uint64_t number_in(const std::string& file) {
    std::ifstream in(file);
    std::uint64_t value = 0;
    return in >> value ? value : kUnknown;
}

std::uint64_t system_available() {
    std::ifstream in("/proc/meminfo");
    std::string key, unit;
    std::uint64_t kibibytes = 0;
    while (in >> key >> kibibytes) {
        if (key == "MemAvailable:") return kibibytes * 1024;
        std::getline(in, unit);
    }
    return kUnknown;
}

std::uint64_t below(std::uint64_t limit, std::uint64_t used) {
    if (limit == kUnknown || used == kUnknown) return kUnknown;
    return limit - std::min(limit, used);
}

// Of control groups, version 2: a container finds its own group here.
std::uint64_t group_available() {
    const std::string group = "/sys/fs/cgroup/memory.";
    return below(number_in(group + "max"), number_in(group + "current"));
}

// Size of this process' address space, or of its resident part [byte].
std::uint64_t process_bytes(bool resident) {
    std::ifstream in("/proc/self/statm");
    std::uint64_t all = 0, present = 0;
    if (!(in >> all >> present)) return 0;
    return (resident ? present : all) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

// RLIMIT_AS
std::uint64_t address_space_limit() {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnknown;
    return limit.rlim_cur;
}

std::uint64_t address_space_available() {
    return below(address_space_limit(), process_bytes(false));
}

}  // namespace

std::uint64_t available_memory_bytes() {
    return std::min({system_available(), group_available(), address_space_available()});
}

std::uint64_t loading_limit(std::uint64_t asked) {
    return asked > 0 ? asked : available_memory_bytes() / 2;
}

std::uint64_t resident_memory_bytes() { return process_bytes(true); }

bool has_address_space_limit() { return address_space_limit() != kUnknown; }

void require_address_space(std::uint64_t bytes, const std::string& what) {
    constexpr std::uint64_t kThreadBytes = std::uint64_t{28}
                                           << 20;  // stack and PoCL's local memory
    constexpr int kArenas = 2;
    const std::uint64_t limit = address_space_limit();
    if (limit == kUnknown) return;
    mallopt(M_ARENA_MAX, kArenas);
    const std::uint64_t need = bytes + kThreadBytes * std::thread::hardware_concurrency();
    const std::uint64_t left = address_space_available();
    if (left >= need) return;
    throw Error("memory: " + what + " " +
                shortage_text(need, "address space", left, limit, "ulimit -v"));
}

std::string shortage_text(std::uint64_t need, const std::string& kind, std::uint64_t left,
                          std::uint64_t limit, const std::string& option) {
    return "needs " + mebibytes(need) + " of " + kind + ", " + std::to_string(left >> 20) +
           " MiB of " + mebibytes(limit) + " are left (" + option + ")";
}

std::string mebibytes(std::uint64_t bytes) {
    return std::to_string((bytes >> 20) + ((bytes & 0xfffff) != 0 ? 1 : 0)) + " MiB";
}

}  // namespace kilolux
