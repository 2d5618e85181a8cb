// SPDX-License-Identifier: Apache-2.0
#include "present/image/prefiltered_cache.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <optional>

#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/base/log.h"
#include "host/base/version.h"
#include "host/gpu/tuning/device_cache.h"

namespace kilolux {
namespace {

constexpr std::string_view kFormat = "kilolux-prefiltered 1 ";
constexpr std::size_t kLargest = std::size_t{64} << 20;  // [byte]; ours have 10 MiB
constexpr std::string_view kPrefix = "prefiltered-";
constexpr std::size_t kMostFiles = 8;

template <typename T>
std::string_view bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

// Identifies the environment and the program.
std::string head_of(const Environment& environment, std::string_view commit) {
    return std::string(kFormat) + version() + " " + std::string(commit) + " " +
           hash_text(bytes_of(environment.rows)) + "\n";
}

std::string body_of(const PrefilteredEnvironment& maps) {
    std::string out;
    const auto add = [&out](const auto& values) {
        const std::uint64_t count = values.size();
        out.append(reinterpret_cast<const char*>(&count), sizeof count);
        out += bytes_of(values);
    };
    add(maps.levels);
    add(maps.texels);
    add(maps.table);
    return out;
}

template <typename T>
bool take(std::string_view& from, std::vector<T>& out) {
    std::uint64_t count = 0;
    if (from.size() < sizeof count) return false;
    std::memcpy(&count, from.data(), sizeof count);
    from.remove_prefix(sizeof count);
    if (count > from.size() / sizeof(T)) return false;
    out.resize(count);
    std::memcpy(out.data(), from.data(), count * sizeof(T));
    from.remove_prefix(count * sizeof(T));
    return true;
}

// A file is head, checksum of the body, body.
std::optional<PrefilteredEnvironment> parsed(std::string_view file, const std::string& head) {
    if (!file.starts_with(head)) return std::nullopt;
    file.remove_prefix(head.size());
    const std::string_view checksum = file.substr(0, file.find('\n'));
    file.remove_prefix(std::min(checksum.size() + 1, file.size()));
    PrefilteredEnvironment out;
    if (hash_text(file) != checksum || !take(file, out.levels) || !take(file, out.texels) ||
        !take(file, out.table)) {
        return std::nullopt;
    }
    while (3 * out.table_size * out.table_size < out.table.size()) ++out.table_size;
    return out;
}

namespace fs = std::filesystem;

// Removes the oldest files beyond those that are kept. Other programs may remove some, too.
void remove_oldest(const fs::path& folder) {
    std::error_code error;
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        if (at->path().filename().native().starts_with(kPrefix)) {
            files.emplace_back(at->last_write_time(error), at->path());
        }
    }
    std::ranges::sort(files, std::greater());
    for (std::size_t i = kMostFiles; i < files.size(); ++i) fs::remove(files[i].second, error);
}

void keep(const fs::path& file, const std::string& head, const PrefilteredEnvironment& maps) {
    const std::string body = body_of(maps);
    try {
        write_cache_file(file, head + hash_text(body) + "\n" + body);
    } catch (const Error& error) {
        detail(error.what());
        return;
    }
    remove_oldest(file.parent_path());
}

}  // namespace

PrefilteredEnvironment kept_prefiltered(const Environment& environment, std::string_view commit) {
    const fs::path folder = cache_folder();
    if (folder.empty()) return prefiltered(environment);
    const std::string head = head_of(environment, commit);
    const fs::path file = folder / (std::string(kPrefix) + hash_text(head));
    if (auto kept = parsed(read_cache_file(file, kLargest), head)) {
        std::error_code error;
        fs::last_write_time(file, fs::file_time_type::clock::now(), error);
        return std::move(*kept);
    }
    PrefilteredEnvironment made = prefiltered(environment);
    keep(file, head, made);
    return made;
}

}  // namespace kilolux
