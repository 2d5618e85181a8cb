// SPDX-License-Identifier: Apache-2.0
#include "host/base/atomic_write.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "host/base/error.h"
#include "host/base/interrupt.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const std::string& what, int code) {
    throw Error(file.string() + ": " + what + ": " + std::strerror(code));
}

fs::path folder_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

// Where the file really is, so that a rename replaces a link's target and not the link.
fs::path target_of(const fs::path& file) {
    std::error_code error;
    const fs::path target = fs::canonical(file, error);
    return error ? file : target;
}

class Descriptor {
 public:
    explicit Descriptor(int value) : value_(value) {}
    ~Descriptor() {
        if (value_ >= 0) close(value_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return value_; }
    // Closes now, where a late write error of a network file system is still heard.
    bool close_now() { return close(std::exchange(value_, -1)) == 0; }

 private:
    int value_;
};

void write_all(const Descriptor& out, const fs::path& file, std::span<const unsigned char> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = write(out.get(), bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(file, "cannot write", errno);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
}

// A new file beside `file` that is removed again unless it is renamed to it.
class TemporaryFile {
 public:
    explicit TemporaryFile(const fs::path& file) : file_(file), out_(create()) {}
    ~TemporaryFile() {
        if (!name_.empty()) unlink(name_.c_str());
        set_unfinished_file({});
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    void fill(std::span<const unsigned char> bytes) {
        write_all(out_, file_, bytes);
        if (fsync(out_.get()) != 0 && errno != EINVAL) fail(file_, "cannot write", errno);
        if (!out_.close_now()) fail(file_, "cannot write", errno);
    }

    void rename_to_file() {
        struct stat old = {};
        if (stat(file_.c_str(), &old) == 0) chmod(name_.c_str(), old.st_mode & 07777);
        if (rename(name_.c_str(), file_.c_str()) != 0) fail(file_, "cannot write", errno);
        name_.clear();
    }

 private:
    int create() {
        for (int attempt = 0;; ++attempt) {
            name_ = folder_of(file_) / (".kilolux-" + std::to_string(getpid()) + "-" +
                                        std::to_string(attempt) + ".part");
            set_unfinished_file(name_);
            const int out = open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (out >= 0) return out;
            const int code = errno;
            set_unfinished_file({});
            name_.clear();
            if (code != EEXIST) fail(file_, "cannot write", code);
        }
    }

    fs::path file_;
    fs::path name_;
    Descriptor out_;
};

// A device, pipe or socket, which a rename would replace.
bool is_special(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

}  // namespace

void write_whole_file(const fs::path& file, std::span<const unsigned char> bytes) {
    if (is_special(file)) {
        Descriptor out(open(file.c_str(), O_WRONLY | O_CLOEXEC));
        if (out.get() < 0) fail(file, "cannot write", errno);
        write_all(out, file, bytes);
        if (!out.close_now()) fail(file, "cannot write", errno);
        return;
    }
    if (fs::is_directory(file)) fail(file, "cannot write", EISDIR);
    TemporaryFile temporary(target_of(file));
    temporary.fill(bytes);
    temporary.rename_to_file();
}

void write_whole_file(const fs::path& file, std::string_view text) {
    write_whole_file(file,
                     std::span(reinterpret_cast<const unsigned char*>(text.data()), text.size()));
}

void check_can_write(const fs::path& file) {
    if (is_special(file)) return;
    if (fs::is_directory(file)) fail(file, "cannot write", EISDIR);
    const fs::path folder = folder_of(target_of(file));
    if (!fs::is_directory(folder)) {
        throw Error(file.string() + ": cannot write: there is no folder " + folder.string());
    }
    if (access(folder.c_str(), W_OK | X_OK) != 0) fail(file, "cannot write", errno);
}

}  // namespace kilolux
