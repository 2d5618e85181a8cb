// SPDX-License-Identifier: Apache-2.0
// Output files appear whole or not at all.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

#include "host/base/system/descriptor.h"

namespace kilolux {

/// Who may read and write a new file.
enum class FileAccess {
    by_umask,   // as the user's mask says; an existing file keeps its mode, a link its target
    owner_only  // mode 0600; an existing file or link is replaced
};

/// A file that is written beside its place under a temporary name and renamed by commit(), so that
/// a reader sees the old file or the new one and never a part. Without commit() nothing changes. A
/// device or pipe is written directly. Every function throws Error with the file and the system's
/// reason.
class AtomicFile {
 public:
    explicit AtomicFile(const std::filesystem::path& file,
                        FileAccess access = FileAccess::by_umask);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::string_view bytes) { out_->write_all(bytes); }
    void commit();

    /// Open for writing, at the end of what was written, until commit().
    int descriptor() const { return out_->get(); }

    /// Where the bytes are until commit(), for another program to write them.
    const std::filesystem::path& path() const { return temporary_.empty() ? file_ : temporary_; }

 private:
    void open_beside(FileAccess access);

    std::filesystem::path file_;
    std::filesystem::path temporary_;  // empty: written directly, or renamed
    std::optional<Descriptor> out_;
};

/// Whether the file is a device, pipe or socket, which AtomicFile writes directly.
bool is_special(const std::filesystem::path& file);

/// Writes a whole AtomicFile.
void write_atomically(const std::filesystem::path& file, std::string_view text,
                      FileAccess access = FileAccess::by_umask);
void write_atomically(const std::filesystem::path& file, std::span<const unsigned char> bytes);

/// Throws Error if write_atomically() would certainly fail: no such folder, a folder of that name,
/// or no permission. Asked before work whose result would be lost.
void check_can_write(const std::filesystem::path& file);

}  // namespace kilolux
