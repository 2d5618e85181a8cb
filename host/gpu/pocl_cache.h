// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace kilolux {

/// Why PoCL cannot keep its compiled kernels in a folder: it cannot be made or written to, has less
/// than 32 MiB left, or code in it may not run. Empty: it can. Makes the folder.
std::string cache_problem(const std::filesystem::path& folder);

/// To be called before OpenCL is: PoCL offers no device, or ends the program, where it cannot keep
/// kernels. Where its folder cannot be used, it gets a private one for this run, and a warning says
/// so; where its linker `ld` is in /usr/bin but not on PATH, PATH gets that folder.
///
/// Returns what is still missing, for errors; empty if nothing is. Later calls do nothing.
const std::string& prepare_pocl();

}  // namespace kilolux
