// SPDX-License-Identifier: Apache-2.0
#include "present/commands/devices/device_share.h"

#include <fmt/format.h>

#include "host/base/error.h"
#include "host/base/log.h"

namespace kilolux {

std::string device_text(const DeviceShare& share) {
    return fmt::format("{} ({})", share.index, share.info.name);
}

std::vector<DeviceShare> shares_of(const std::vector<std::string>& devices) {
    std::vector<DeviceShare> out;
    for (const std::string& index : devices) out.push_back({index, describe(choose_device(index))});
    return out;
}

std::string share_lines(const std::vector<DeviceShare>& shares) {
    bool by_rows = false;
    for (const DeviceShare& share : shares) by_rows |= share.rows > 0;
    std::string out;
    for (const DeviceShare& share : shares) {
        const std::string made =
            by_rows ? fmt::format("{} rows in {:.2f} ms", share.rows, share.stats.frame_ms)
                    : fmt::format("{} pictures", share.pictures);
        out += fmt::format("{}device {}: {}", out.empty() ? "" : "\n", device_text(share), made);
    }
    return out;
}

nlohmann::ordered_json shares_json(const std::vector<DeviceShare>& shares) {
    auto out = nlohmann::ordered_json::array();
    for (const DeviceShare& share : shares) {
        nlohmann::ordered_json entry = {
            {"index", share.index}, {"name", share.info.name},         {"pictures", share.pictures},
            {"rows", share.rows},   {"rows_ms", share.stats.frame_ms}, {"failure", nullptr}};
        if (!share.failure.empty()) entry["failure"] = share.failure;
        out.push_back(std::move(entry));
    }
    return out;
}

std::string failures_of(const std::vector<DeviceShare>& shares) {
    std::string out;
    for (const DeviceShare& share : shares) {
        if (share.failure.empty()) continue;
        out += fmt::format("{}device {} failed: {}", out.empty() ? "" : "; ", device_text(share),
                           share.failure);
    }
    return out;
}

void run_share(DeviceShare& share, std::atomic<std::size_t>& left,
               const std::function<void(std::exception_ptr)>& fail,
               const std::function<void()>& run) noexcept {
    try {
        run();
    } catch (const UsageError&) {
        fail(std::current_exception());
    } catch (const Interrupted&) {
        fail(std::current_exception());
    } catch (const std::exception& error) {
        share.failure = error.what();
        if (--left == 0) return fail(std::current_exception());
        warn(fmt::format("device {} is left out: {}", device_text(share), error.what()));
    }
}

}  // namespace kilolux
