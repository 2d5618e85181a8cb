// SPDX-License-Identifier: Apache-2.0
// Packages of npm that tests run.
#pragma once

#include <initializer_list>

#include "tests/support/child.h"

namespace kilolux {

/// A folder of the build with the packages that tests/<from> pins, `package` among them. Empty,
/// with the reason in `why`, where one of `tools` is missing or npm fails.
inline std::filesystem::path install_npm(const std::string& from, const std::string& package,
                                         std::initializer_list<const char*> tools,
                                         std::string& why) {
    namespace fs = std::filesystem;
    const fs::path source = fs::path(source_root()) / "tests" / from;
    const fs::path folder = fs::path(program_file()).parent_path() / "npm" / source.filename();
    for (const char* tool : tools) {
        if (run_child({"/usr/bin/env", tool, "--version"}).code == 0) continue;
        why = std::string(tool) + " is not installed; tests/run installs it";
        return {};
    }
    if (fs::exists(folder / "node_modules" / package / "package.json")) return folder;
    fs::create_directories(folder);
    for (const char* name : {"package.json", "package-lock.json"}) {
        fs::copy_file(source / name, folder / name, fs::copy_options::overwrite_existing);
    }
    const ChildResult npm = run_child({"/usr/bin/env", "npm", "ci", "--ignore-scripts",
                                       "--no-audit", "--no-fund", "--prefix", folder.string()});
    if (npm.code == 0) return folder;
    why = "npm cannot install " + package + ": " + npm.err;
    return {};
}

}  // namespace kilolux
