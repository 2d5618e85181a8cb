// SPDX-License-Identifier: Apache-2.0
#include "host/base/system/read_text.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "host/base/error.h"

namespace kilolux {

std::string read_text(const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) {
        throw Error(file.string() + ": cannot read: " + std::strerror(EISDIR));
    }
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    if (in) text << in.rdbuf();  // an empty file sets failbit of `text`, not of `in`
    if (!in || in.bad()) throw Error(file.string() + ": cannot read: " + std::strerror(errno));
    return text.str();
}

}  // namespace kilolux
