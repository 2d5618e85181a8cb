// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace kilolux {

/// Memory that this process can still get [byte]: the least of the system's available memory, the
/// control group's limit and the limit of the address space (RLIMIT_AS). 2^64 - 1 if all are
/// unknown.
std::uint64_t available_memory_bytes();

/// "1536 MiB", rounded up.
std::string mebibytes(std::uint64_t bytes);

}  // namespace kilolux
