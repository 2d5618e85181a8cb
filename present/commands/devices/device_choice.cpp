// SPDX-License-Identifier: Apache-2.0
#include "present/commands/devices/device_choice.h"

#include <fmt/format.h>
#include <optional>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/text.h"
#include "host/gpu/device.h"
#include "present/cli/option_values.h"

namespace kilolux {
namespace {

// "0,2" as indices. Throws UsageError for another text.
std::vector<std::string> indices_of(const std::string& choice) {
    std::vector<std::string> out;
    for (const std::string_view text : split(choice, ',')) {
        const std::optional<std::uint64_t> index = count_of(text);
        if (!index) {
            throw UsageError(fmt::format("--device {}: '{}' is no index", choice, text));
        }
        out.push_back(fmt::to_string(*index));
    }
    return out;
}

bool computes_alike(const DeviceInfo& a, const DeviceInfo& b) {
    return a.name == b.name && a.platform == b.platform && a.driver == b.driver;
}

// The indices of the devices like the one that is chosen where none is asked for; with `mixed` all.
std::vector<std::string> all_like_the_best(bool mixed) {
    const DeviceInfo best = describe(choose_device(""));
    std::vector<std::string> out;
    std::string others;
    const std::size_t count = all_devices().size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::string index = fmt::to_string(i);
        const DeviceInfo device = describe(choose_device(index));
        if (mixed || computes_alike(best, device)) {
            out.push_back(index);
        } else {
            others += (others.empty() ? "" : ", ") + index + " (" + device.name + ")";
        }
    }
    if (!others.empty()) {
        note(
            fmt::format("device  all like {}; --mixed-devices also takes {}, which may differ in "
                        "digits",
                        best.name, others));
    }
    return out;
}

}  // namespace

std::vector<std::string> devices_of(const std::string& choice, bool mixed) {
    if (choice == "all") return all_like_the_best(mixed);
    std::vector<std::string> out;
    if (choice.find(',') != std::string::npos &&
        choice.find_first_not_of("0123456789,") == std::string::npos) {
        out = indices_of(choice);
    }
    if (out.empty()) return {choice};
    const DeviceInfo first = describe(choose_device(out.front()));
    for (const std::string& index : out) {
        const DeviceInfo other = describe(choose_device(index));
        if (mixed || computes_alike(first, other)) continue;
        throw UsageError(
            fmt::format("--device {}: {} ({}) and {} ({}) may differ in digits; "
                        "--mixed-devices allows that",
                        choice, out.front(), first.name, index, other.name));
    }
    return out;
}

}  // namespace kilolux
