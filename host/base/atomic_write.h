// SPDX-License-Identifier: Apache-2.0
// Output files appear whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace kilolux {

/// Writes a file beside its place under a temporary name and renames it there, so that a reader
/// sees the old file or the new one and never a part. A link keeps pointing where it points; a
/// device or pipe is written directly. Throws Error with the file and the system's reason; then
/// nothing has changed.
void write_whole_file(const std::filesystem::path& file, std::span<const unsigned char> bytes);
void write_whole_file(const std::filesystem::path& file, std::string_view text);

/// Throws Error if write_whole_file() would certainly fail: no such folder, a folder of that name,
/// or no permission. Asked before work whose result would be lost.
void check_can_write(const std::filesystem::path& file);

}  // namespace kilolux
