// SPDX-License-Identifier: Apache-2.0
#include "present/commands/devices/report_devices.h"

#include <fmt/format.h>

#include <atomic>
#include <exception>
#include <utility>

#include "host/base/system/interrupt.h"
#include "present/commands/devices/device_share.h"
#include "present/commands/devices/shared_tasks.h"

namespace kilolux {
namespace {

ReportDevice opened_device(const DeviceShare& share, const ReportView& view) {
    return {std::make_shared<const Gpu>(choose_device(share.index)), shared_scene(view.scene)};
}

// The settings that devices compare with the references at once.
struct Comparing {
    ReportRun& run;
    const ReportJob& job;
    SharedTasks queue{0, job.settings.size(), job.settings.size()};
    std::vector<ComparedRow> rows = std::vector<ComparedRow>(job.settings.size());
    RenderSettings memory{};  // its members of memory, while all compare
};

ComparedRow compared_row(const Comparing& all, const ReportSetting& asked,
                         const ReportDevice& device) {
    ReportSetting setting = asked;
    setting.settings.max_memory_bytes = all.memory.max_memory_bytes;
    setting.settings.memory_shares = all.memory.memory_shares;
    setting.settings.device_shares = all.memory.device_shares;
    ComparedRow row = all.run.compare(setting, device);
    row.row.setting = asked;  // one device alone measures its time
    return row;
}

// Compares settings until none is left, or the device fails, which throws.
void compare_settings(Comparing& all, const ReportDevice& device, DeviceShare& share) {
    while (const std::optional<std::size_t> i = all.queue.take()) {
        try {
            check_interrupt();
            all.rows[*i] = compared_row(all, all.job.settings[*i], device);
        } catch (...) {
            all.queue.give_back(*i);
            throw;
        }
        ++share.finished;
        all.queue.deliver(*i, all.job.on_progress);
    }
}

std::vector<std::string> indices_of(const std::vector<DeviceShare>& shares) {
    std::vector<std::string> out;
    for (const DeviceShare& share : shares) out.push_back(share.index);
    return out;
}

std::vector<ComparedRow> compare_on(std::vector<DeviceShare>& shares,
                                    std::atomic<std::size_t>& left, ReportRun& run,
                                    const ReportJob& job) {
    Comparing all{run, job};
    all.memory = job.settings.front().settings;
    share_memory(all.memory, indices_of(shares));
    run_shares(shares, left, all.queue, [&](std::size_t i) {
        const ReportDevice device = i == 0 ? run.device() : opened_device(shares[i], job.view);
        compare_settings(all, device, shares[i]);
    });
    return std::move(all.rows);
}

// Times all rows on the run's device.
std::vector<ReportRow> timed_rows(ReportRun& run, const std::vector<ComparedRow>& compared,
                                  const ReportJob& job) {
    std::vector<ComparedRow> rows = compared;
    for (ComparedRow& row : rows) run.estimate_again(row);
    return run.time(std::move(rows), job.frames);
}

}  // namespace

SharedReport measure_on(const std::vector<std::string>& devices, ReportRun& run,
                        const ReportJob& job) {
    SharedReport out{{}, shares_of(devices)};
    std::vector<DeviceShare>& shares = out.shares;
    std::atomic<std::size_t> left = shares.size();
    run.on_progress(job.on_progress);
    const std::vector<ComparedRow> compared = compare_on(shares, left, run, job);
    std::size_t timing = 0;  // device
    std::exception_ptr failure;
    const auto fail = [&](std::exception_ptr what) { failure = std::move(what); };
    for (; out.rows.empty() && !failure; ++timing) {
        DeviceShare& share = shares[timing];
        if (!share.failure.empty()) continue;
        run_share(share, left, fail, [&] {
            if (timing > 0) run.move_to(opened_device(share, job.view));
            out.rows = timed_rows(run, compared, job);
        });
        run.on_progress([] {});  // of another device that starts anew
    }
    if (failure) std::rethrow_exception(failure);
    shares[timing - 1].has_timed = true;
    return out;
}

std::string device_lines(const std::vector<DeviceShare>& shares) {
    std::string out;
    for (const DeviceShare& share : shares) {
        out += fmt::format("device {}: errors of {} settings{}{}\n", device_text(share),
                           share.finished, share.has_timed ? ", all times" : "",
                           share.failure.empty() ? "" : "; left out: " + share.failure);
    }
    return out;
}

nlohmann::ordered_json devices_json(const std::vector<DeviceShare>& shares) {
    auto out = nlohmann::ordered_json::array();
    for (const DeviceShare& share : shares) {
        out.push_back({{"device", device_text(share)},
                       {"settings", share.finished},
                       {"times", share.has_timed},
                       {"failure", failure_json(share)}});
    }
    return out;
}

}  // namespace kilolux
