// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/tuning/device_cache.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/base/log.h"
#include "host/base/system/atomic_write.h"
#include "host/base/text.h"
#include "host/base/version.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

// An entry is lines of text: format, kind and version; the program; the device;
// then a "key value" line for each number, and last the checksum of all before it.
constexpr std::string_view kFormat = "kilolux-cache 1";
constexpr std::string_view kChecksum = "checksum ";
constexpr std::size_t kLargestEntry = std::size_t{64} * 1024;  // [byte]; ours have about one KiB

fs::path absolute_folder(const char* variable) {
    const char* value = std::getenv(variable);
    const fs::path folder = value ? value : "";
    return folder.is_absolute() ? folder : fs::path();
}

std::string one_line(std::string text) {
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    }
    return text;
}

// Names the device and everything whose change makes old numbers wrong.
std::string device_lines(const DeviceInfo& device) {
    return "device " + one_line(device.name) + "\nversion " + one_line(device.version) +
           "\ndriver " + one_line(device.driver) + "\nplatform " + one_line(device.platform) +
           "\ncompute_units " + std::to_string(device.compute_units) + "\n";
}

std::string head_lines(const DeviceInfo& device, CacheKind kind) {
    return std::string(kFormat) + " " + std::string(kind.name) + " " +
           std::to_string(kind.version) + "\nprogram " + version() + "\n" + device_lines(device);
}

// A file that only this user could have written: nobody else's numbers decide how kernels are
// built.
bool is_ours(int descriptor, std::size_t most_bytes) {
    struct stat status = {};
    return ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) &&
           status.st_uid == ::geteuid() && (status.st_mode & (S_IWGRP | S_IWOTH)) == 0 &&
           status.st_size <= static_cast<off_t>(most_bytes);
}

std::string read_all(int descriptor, std::size_t most_bytes) {
    std::string text(most_bytes, '\0');
    std::size_t size = 0;
    while (size < text.size()) {
        const ssize_t count = ::read(descriptor, text.data() + size, text.size() - size);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;
        size += static_cast<std::size_t>(count);
    }
    text.resize(size);
    return text;
}

// What stands before a right checksum line at the end; none if it is wrong or missing.
std::optional<std::string_view> checked_text(std::string_view entry) {
    const std::size_t line = entry.rfind(kChecksum);
    if (line == std::string_view::npos) return std::nullopt;
    const std::string_view text = entry.substr(0, line);
    const std::string expected = std::string(kChecksum) + hash_text(text) + "\n";
    if (entry.substr(line) != expected) return std::nullopt;
    return text;
}

std::optional<CacheValues> parse_values(std::string_view text) {
    CacheValues values;
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        const std::size_t space = line.find(' ');
        if (space == std::string_view::npos || space == 0) return std::nullopt;
        const auto value = number_of<double>(line.substr(space + 1));
        if (!value || !std::isfinite(*value)) return std::nullopt;
        values.emplace(line.substr(0, space), *value);
    }
    return values;
}

std::optional<CacheValues> parse_entry(std::string_view entry, const std::string& head) {
    const auto text = checked_text(entry);
    if (!text || !text->starts_with(head)) return std::nullopt;
    return parse_values(text->substr(head.size()));
}

std::string shortest(double value) {
    char text[32];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value);
    return {text, end};
}

std::string entry_text(const std::string& head, const CacheValues& values) {
    std::string text = head;
    for (const auto& [key, value] : values) text += key + " " + shortest(value) + "\n";
    return text + std::string(kChecksum) + hash_text(text) + "\n";
}

[[noreturn]] void fail(const fs::path& path, const char* what, int code) {
    throw Error("cache: " + path.string() + ": " + what + ": " + std::strerror(code));
}

// A folder of ours, only for its owner; the folders above it as the user's mask has it.
void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder.parent_path(), error);
    if (error) fail(folder.parent_path(), "cannot make the folder", error.value());
    if (::mkdir(folder.c_str(), S_IRWXU) != 0 && errno != EEXIST) {
        fail(folder, "cannot make the folder", errno);
    }
}

}  // namespace

fs::path cache_folder() {
    const fs::path xdg = absolute_folder("XDG_CACHE_HOME");
    if (!xdg.empty()) return xdg / "kilolux";
    const fs::path home = absolute_folder("HOME");
    return home.empty() ? fs::path() : home / ".cache" / "kilolux";
}

std::string read_cache_file(const fs::path& file, std::size_t most_bytes) {
    // Follows no link, and does not wait for the other end of a pipe.
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (descriptor < 0) return {};
    std::string text =
        is_ours(descriptor, most_bytes) ? read_all(descriptor, most_bytes) : std::string();
    ::close(descriptor);
    return text;
}

void write_cache_file(const fs::path& file, std::string_view bytes) {
    make_folder(file.parent_path());
    write_atomically(file, bytes, FileAccess::owner_only);
}

fs::path device_cache_file(const DeviceInfo& device, CacheKind kind) {
    const fs::path folder = cache_folder();
    if (folder.empty()) return {};
    return folder / (std::string(kind.name) + "-" + hash_text(device_lines(device)) + ".txt");
}

std::optional<CacheValues> read_device_cache(const DeviceInfo& device, CacheKind kind) {
    const fs::path file = device_cache_file(device, kind);
    if (file.empty()) return std::nullopt;
    const std::string entry = read_cache_file(file, kLargestEntry);
    if (entry.empty()) return std::nullopt;
    auto values = parse_entry(entry, head_lines(device, kind));
    if (!values) detail("cache: " + file.string() + ": not used: damaged or of another version");
    return values;
}

void write_device_cache(const DeviceInfo& device, CacheKind kind, const CacheValues& values) {
    const fs::path file = device_cache_file(device, kind);
    if (file.empty()) throw Error("cache: no folder: neither XDG_CACHE_HOME nor HOME is a path");
    write_cache_file(file, entry_text(head_lines(device, kind), values));
}

}  // namespace kilolux
