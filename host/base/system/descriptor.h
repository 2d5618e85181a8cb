// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace kilolux {

/// Throws Error "<file>: cannot write: <reason of errno>".
[[noreturn]] void fail_to_write(const std::filesystem::path& file);

/// Has the disk take what was written to the file, while more is made: to flush it all at the end
/// takes as long as to write it. Nothing for pipes and devices.
void begin_flush(int descriptor);

/// A file descriptor that is open for writing and closes itself.
class Descriptor {
 public:
    /// What ::open() returned for `file`; throws Error if that is a failure.
    Descriptor(int number, std::filesystem::path file);
    ~Descriptor();
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return number_; }

    /// Throws Error with the file and the system's reason.
    void write_all(std::string_view bytes) const;

    /// Flushes to the disk and closes: network file systems report late write errors here. Throws
    /// Error likewise.
    void finish();

 private:
    int number_;
    std::filesystem::path file_;
};

}  // namespace kilolux
