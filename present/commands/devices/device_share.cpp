// SPDX-License-Identifier: Apache-2.0
#include "present/commands/devices/device_share.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/render/plan/memory_plan.h"

namespace kilolux {

std::string device_text(const DeviceShare& share) {
    return fmt::format("{} ({})", share.index, share.info.name);
}

std::vector<DeviceShare> shares_of(const std::vector<std::string>& devices) {
    std::vector<DeviceShare> out;
    for (const std::string& index : devices) out.push_back({index, describe(choose_device(index))});
    return out;
}

void share_memory(RenderSettings& settings, const std::vector<std::string>& devices) {
    if (devices.size() < 2) return;
    settings.max_memory_bytes = memory_limit(settings);
    settings.memory_shares = static_cast<int>(devices.size());
    for (const std::string& device : devices) {
        const auto same = static_cast<int>(std::ranges::count(devices, device));
        settings.device_shares = std::max(settings.device_shares, same);
    }
}

std::string share_lines(const std::vector<DeviceShare>& shares) {
    bool by_rows = false;
    for (const DeviceShare& share : shares) by_rows |= share.rows > 0;
    std::string out;
    for (const DeviceShare& share : shares) {
        const std::string made =
            by_rows ? fmt::format("{} rows in {:.2f} ms", share.rows, share.stats.frame_ms)
                    : fmt::format("{} pictures", share.finished);
        out += fmt::format("{}device {}: {}", out.empty() ? "" : "\n", device_text(share), made);
    }
    return out;
}

nlohmann::ordered_json shares_json(const std::vector<DeviceShare>& shares) {
    auto out = nlohmann::ordered_json::array();
    for (const DeviceShare& share : shares) {
        out.push_back({{"index", share.index},
                       {"name", share.info.name},
                       {"pictures", share.finished},
                       {"rows", share.rows},
                       {"rows_ms", share.stats.frame_ms},
                       {"failure", failure_json(share)}});
    }
    return out;
}

nlohmann::ordered_json failure_json(const DeviceShare& share) {
    if (share.failure.empty()) return nullptr;
    return share.failure;
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

void run_shares(std::vector<DeviceShare>& shares, std::atomic<std::size_t>& left,
                SharedTasks& queue, const std::function<void(std::size_t device)>& work) {
    const auto run = [&](std::size_t i) {
        run_share(
            shares[i], left, [&](std::exception_ptr e) { queue.fail(std::move(e)); },
            [&] { work(i); });
    };
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < shares.size(); ++i) threads.emplace_back(run, i);
    run(0);
    threads.clear();  // waits for them
    queue.rethrow();
}

}  // namespace kilolux
