// SPDX-License-Identifier: Apache-2.0
#include "host/base/system/atomic_write.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>

#include "host/base/error.h"
#include "host/base/system/interrupt.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

// Renaming onto a link would replace the link: returns the link's target, which need not exist.
// Throws Error for links that lead to each other.
fs::path target_of(fs::path file) {
    constexpr int kMostLinks = 40;  // as Linux follows (path_resolution(7))
    std::error_code error;
    for (int link = 0; link < kMostLinks && fs::is_symlink(fs::symlink_status(file, error));
         ++link) {
        const fs::path target = fs::read_symlink(file, error);
        if (error) break;
        file = folder_of(file) / target;
    }
    if (fs::is_symlink(fs::symlink_status(file, error))) {
        errno = ELOOP;
        fail_to_write(file);
    }
    return file;
}

void refuse_folder(const fs::path& file) {
    std::error_code error;
    if (!fs::is_directory(file, error)) return;
    errno = EISDIR;
    fail_to_write(file);
}

}  // namespace

// A rename would replace it.
bool is_special(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

AtomicFile::AtomicFile(const fs::path& file, FileAccess access)
    : file_(access == FileAccess::by_umask ? target_of(file) : file) {
    if (access == FileAccess::by_umask && is_special(file)) {
        out_.emplace(::open(file.c_str(), O_WRONLY | O_CLOEXEC), file);
        return;
    }
    refuse_folder(file);
    open_beside(access);
}

AtomicFile::~AtomicFile() {
    if (temporary_.empty()) return;
    ::unlink(temporary_.c_str());
    forget_unfinished_file(temporary_);
}

void AtomicFile::open_beside(FileAccess access) {
    const mode_t mode = access == FileAccess::owner_only ? 0600 : 0666;
    for (int attempt = 0;; ++attempt) {
        const fs::path name = folder_of(file_) / (".kilolux-" + std::to_string(::getpid()) + "-" +
                                                  std::to_string(attempt) + ".part");
        const int number = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
        if (number < 0 && errno == EEXIST) continue;  // another thread or machine has this name
        out_.emplace(number, file_);
        temporary_ = name;
        add_unfinished_file(name);
        break;
    }
    struct stat old = {};
    const bool keeps_mode = access == FileAccess::by_umask && ::stat(file_.c_str(), &old) == 0;
    if (keeps_mode) ::fchmod(out_->get(), old.st_mode & 07777);
}

void AtomicFile::commit() {
    out_->finish();
    if (temporary_.empty()) return;
    if (::rename(temporary_.c_str(), file_.c_str()) != 0) fail_to_write(file_);
    forget_unfinished_file(temporary_);
    temporary_.clear();
}

void write_atomically(const fs::path& file, std::string_view text, FileAccess access) {
    AtomicFile out(file, access);
    out.write(text);
    out.commit();
}

void write_atomically(const fs::path& file, std::span<const unsigned char> bytes) {
    write_atomically(file,
                     std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

void check_can_write(const fs::path& file) {
    if (is_special(file)) return;
    refuse_folder(file);
    const fs::path folder = folder_of(target_of(file));
    std::error_code error;
    if (!fs::is_directory(folder, error)) {
        throw Error(file.string() + ": cannot write: there is no folder " + folder.string());
    }
    if (::access(folder.c_str(), W_OK | X_OK) != 0) fail_to_write(file);
    const long longest = ::pathconf(folder.c_str(), _PC_NAME_MAX);
    if (longest > 0 && file.filename().native().size() > static_cast<std::size_t>(longest)) {
        errno = ENAMETOOLONG;
        fail_to_write(file);
    }
}

}  // namespace kilolux
