// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "host/base/error.h"

namespace kilolux {

/// A temporary folder that is gone with this.
class ScratchFolder {
 public:
    ScratchFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "kilolux-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) throw Error(name + ": cannot make this folder");
        folder_ = name;
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    std::string file(const char* name) const { return (folder_ / name).string(); }

 private:
    std::filesystem::path folder_;
};

}  // namespace kilolux
