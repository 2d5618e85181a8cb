// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace kilolux {

/// Memory that this process can still get [byte]: the least of the system's available memory, the
/// control group's limit and the limit of the address space (RLIMIT_AS). 2^64 - 1 if all are
/// unknown.
std::uint64_t available_memory_bytes();

/// What loading may take: `asked`, or half of what is available where that is 0 [byte].
std::uint64_t loading_limit(std::uint64_t asked);

/// Resident memory of this process [byte].
std::uint64_t resident_memory_bytes();

/// Whether the address space is limited (RLIMIT_AS).
bool has_address_space_limit();

/// Throws Error if the limit of the address space (ulimit -v) leaves less than `bytes` and a stack
/// for each core. Call it before loading `what` ("the library of images"), which would crash or
/// never return with less. If there is a limit, all threads share two of malloc's arenas
/// afterwards: an arena reserves 64 MiB.
void require_address_space(std::uint64_t bytes, const std::string& what);

/// "1536 MiB", rounded up.
std::string mebibytes(std::uint64_t bytes);

/// "needs 5 MiB of memory for images, 3 MiB of 9 MiB are left (--max-memory)": of a `kind` of
/// memory whose `limit` an option sets.
std::string shortage_text(std::uint64_t need, const std::string& kind, std::uint64_t left,
                          std::uint64_t limit, const std::string& option = "--max-memory");

}  // namespace kilolux
