// SPDX-License-Identifier: Apache-2.0
#include "host/base/system/read_text.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "host/base/error.h"

namespace kilolux {
namespace {

// Devices and pipes may have no end.
constexpr std::size_t kMostBytes = std::size_t{256} << 20;

}  // namespace

std::string read_text(const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) {
        throw Error(file.string() + ": cannot read: " + std::strerror(EISDIR));
    }
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    std::string text;
    const auto size = std::filesystem::file_size(file, error);
    if (!error) text.reserve(std::min<std::uintmax_t>(size, kMostBytes));
    std::string piece(std::size_t{1} << 16, '\0');
    while (in && text.size() <= kMostBytes) {
        in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
        text.append(piece, 0, static_cast<std::size_t>(in.gcount()));
    }
    if (text.size() > kMostBytes) {
        throw Error(file.string() + ": cannot read: is larger than 256 MiB, the most that is read");
    }
    if (in.bad() || !in.eof()) {
        throw Error(file.string() + ": cannot read: " + std::strerror(errno));
    }
    return text;
}

}  // namespace kilolux
