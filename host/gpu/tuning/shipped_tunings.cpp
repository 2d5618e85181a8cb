// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/tuning/shipped_tunings.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <string_view>

#include "host/base/error.h"

namespace kilolux {
namespace {

// GPUs of one chip that differ in memory and clock rates: what is fastest on one is on the others.
constexpr std::array<std::array<std::string_view, 4>, 1> kFamilies = {
    {{"NVIDIA H100", "NVIDIA H200", "NVIDIA H800", "NVIDIA GH200"}}};

bool is_family(std::string_view a, std::string_view b) {
    const auto holds = [](const auto& family, std::string_view name) {
        return std::ranges::any_of(
            family, [&](std::string_view member) { return name.starts_with(member); });
    };
    return std::ranges::any_of(
        kFamilies, [&](const auto& family) { return holds(family, a) && holds(family, b); });
}

}  // namespace

std::optional<ShippedMatch> shipped_tuning(const DeviceInfo& device,
                                           std::span<const ShippedTuning> table) {
    const auto is_device = [&](const ShippedTuning& row) {
        return row.platform == device.platform && row.device == device.name &&
               row.is_cpu == device.is_cpu;
    };
    const auto is_relative = [&](const ShippedTuning& row) {
        return row.platform == device.platform && !row.is_cpu && !device.is_cpu &&
               is_family(row.device, device.name);
    };
    const auto is_class = [&](const ShippedTuning& row) {
        return row.platform == device.platform && row.is_cpu == device.is_cpu &&
               (!device.is_cpu || row.version == device.version);
    };
    auto found = std::ranges::find_if(table, is_device);
    const bool same_device = found != table.end();
    if (!same_device) found = std::ranges::find_if(table, is_relative);
    const bool same_chip = found != table.end();
    if (!same_chip) found = std::ranges::find_if(table, is_class);
    if (found == table.end()) return std::nullopt;
    ShippedMatch match = {found->tuning, same_device};
    int& chunks = match.tuning.tuning.cull_chunks;
    chunks = std::clamp(chunks * device.compute_units / found->compute_units, 1, 65536);
    if (!same_chip && !device.is_cpu) match.tuning.tuning.geometry = 0;
    return match;
}

std::optional<StoredTuning> forced_tuning(const DeviceInfo& device) {
    const char* name = std::getenv("KILOLUX_SHIPPED_TUNING");
    if (name == nullptr) return std::nullopt;
    bool is_known = false;
    for (const ShippedTuning& row : shipped_tunings()) {
        if (row.device.find(name) == std::string_view::npos) continue;
        is_known = true;
        if (row.is_cpu == device.is_cpu && is_valid(row.tuning, device)) return row.tuning;
    }
    if (!is_known) {
        throw Error(std::string("KILOLUX_SHIPPED_TUNING=") + name +
                    ": no tuning is shipped for it");
    }
    return std::nullopt;
}

}  // namespace kilolux
