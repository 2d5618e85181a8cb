// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "host/gpu/device.h"

namespace kilolux {

/// What a cache entry holds: numbers by name. Names are single words.
using CacheValues = std::map<std::string, double, std::less<>>;

/// A kind of entry, e.g. {"limits", 1}. A new version makes older entries foreign.
struct CacheKind {
    std::string_view name;
    int version = 1;
};

/// The user's cache folder of this program: $XDG_CACHE_HOME/kilolux, else $HOME/.cache/kilolux;
/// empty when the environment names neither (XDG Base Directory Specification: relative paths do
/// not count).
std::filesystem::path cache_folder();

/// A whole file of that folder; empty when there is none of at most `most_bytes` that belongs to
/// this user and only this user may write.
std::string read_cache_file(const std::filesystem::path& file, std::size_t most_bytes);

/// Writes it beside its place and renames it, readable by its owner only. Throws Error.
void write_cache_file(const std::filesystem::path& file, std::string_view bytes);

/// Where the entry of a device lies: one file for each device, driver and kind; empty without a
/// folder.
std::filesystem::path device_cache_file(const DeviceInfo& device, CacheKind kind);

/// The device's entry; none when there is no whole, unharmed entry of this kind, version and device
/// that belongs to this user and only this user may write. --verbose reports an entry that cannot
/// be used; the caller makes a new one.
std::optional<CacheValues> read_device_cache(const DeviceInfo& device, CacheKind kind);

/// Writes the device's entry beside its place and renames it, readable by its owner only. Numbers
/// come back exactly. Throws Error with the path and the reason when it cannot be written.
void write_device_cache(const DeviceInfo& device, CacheKind kind, const CacheValues& values);

}  // namespace kilolux
