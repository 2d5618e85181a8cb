// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace kilolux {

/// A file's bytes. Throws Error "<file>: cannot read: <the system's reason>", also for
/// more than 256 MiB.
std::string read_text(const std::filesystem::path& file);

}  // namespace kilolux
