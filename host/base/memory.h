// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace kilolux {

/// Memory that this process can still get [byte]: what the system calls available, less where a
/// control group or the limit of the address space (RLIMIT_AS) says so. 2^64 - 1 where nothing
/// says.
std::uint64_t available_memory_bytes();

/// "1536 MiB", rounded up.
std::string mebibytes(std::uint64_t bytes);

}  // namespace kilolux
