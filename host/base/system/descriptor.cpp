// SPDX-License-Identifier: Apache-2.0
#include "host/base/system/descriptor.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "host/base/error.h"

namespace kilolux {

void fail_to_write(const std::filesystem::path& file) {
    throw Error(file.string() + ": cannot write: " + std::strerror(errno));
}

void begin_flush(int descriptor) { ::sync_file_range(descriptor, 0, 0, SYNC_FILE_RANGE_WRITE); }

Descriptor::Descriptor(int number, std::filesystem::path file)
    : number_(number), file_(std::move(file)) {
    if (number_ < 0) fail_to_write(file_);
}

Descriptor::~Descriptor() {
    if (number_ >= 0) ::close(number_);
}

void Descriptor::write_all(std::string_view bytes) const {
    while (!bytes.empty()) {
        const ssize_t written = ::write(number_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail_to_write(file_);
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

void Descriptor::finish() {
    // EINVAL: pipes and devices cannot be flushed.
    if (::fsync(number_) != 0 && errno != EINVAL && errno != ENOTSUP) fail_to_write(file_);
    if (::close(std::exchange(number_, -1)) != 0) fail_to_write(file_);
}

}  // namespace kilolux
