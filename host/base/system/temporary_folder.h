// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include "host/base/error.h"

namespace kilolux {

/// A new folder with a unique name; the destructor removes it with its contents.
class TemporaryFolder {
 public:
    /// Throws Error with the system's reason.
    explicit TemporaryFolder(
        const std::filesystem::path& parent = std::filesystem::temp_directory_path()) {
        std::string name = (parent / ".kilolux-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) {
            throw Error(parent.string() + ": cannot make a folder in it: " + std::strerror(errno));
        }
        path_ = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
    std::filesystem::path path_;
};

}  // namespace kilolux
