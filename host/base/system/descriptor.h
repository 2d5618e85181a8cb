// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace kilolux {

/// Throws Error "<file>: cannot write: <reason of errno>".
[[noreturn]] void fail_to_write(const std::filesystem::path& file);

/// Starts the transfer of written bytes to the disk and does not wait for it, so that finish() has
/// little left to flush. Does nothing for pipes and devices.
void begin_flush(int descriptor);

/// A file descriptor for writing, which its destructor closes.
class Descriptor {
 public:
    /// `number`: what ::open() returned for `file`. Throws Error if that is -1.
    Descriptor(int number, std::filesystem::path file);
    ~Descriptor();
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return number_; }

    /// Writes all bytes. Throws Error with the file and the system's reason.
    void write_all(std::string_view bytes) const;

    /// Flushes to the disk and closes. Throws Error as write_all(): network file systems report
    /// some errors of writing only here.
    void finish();

 private:
    int number_;
    std::filesystem::path file_;
};

}  // namespace kilolux
