// SPDX-License-Identifier: Apache-2.0
// A job that several devices do, each in a thread of its own.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/gpu/device.h"
#include "host/picture/frame.h"
#include "host/render/settings.h"
#include "present/commands/devices/shared_tasks.h"

namespace kilolux {

/// What a device of several has done.
struct DeviceShare {
    std::string index;  // of --list-devices
    DeviceInfo info{};
    std::size_t finished = 0;  // whole pictures; of a report, settings whose errors it measured
    bool has_timed = false;    // all settings of a report
    // Of a picture that is made by rows.
    int rows = 0;
    FrameStats stats{};
    std::string failure{};  // why it was left out; empty: it was not
};

/// "0 (its name)".
std::string device_text(const DeviceShare& share);

/// The shares of the devices with these indices; they have done nothing.
std::vector<DeviceShare> shares_of(const std::vector<std::string>& devices);

/// Gives renderers that work at once, one for each of `devices`, equal parts of the host's memory
/// and of a device's that stands there several times.
void share_memory(RenderSettings& settings, const std::vector<std::string>& devices);

/// "device 0 (its name): 540 rows in 12.3 ms" or "7 pictures", a line a device.
std::string share_lines(const std::vector<DeviceShare>& shares);

/// The list of --stats.
nlohmann::ordered_json shares_json(const std::vector<DeviceShare>& shares);

/// Null where it did not fail.
nlohmann::ordered_json failure_json(const DeviceShare& share);

/// Which devices failed, and with what; empty: none.
std::string failures_of(const std::vector<DeviceShare>& shares);

/// Runs a device's part of a job. Where it throws, the device is left out with one line; `left`
/// counts those that were not. `fail` gets what ends the whole job: an interruption, a wrong
/// option, the failure of the last device.
void run_share(DeviceShare& share, std::atomic<std::size_t>& left,
               const std::function<void(std::exception_ptr)>& fail,
               const std::function<void()>& run) noexcept;

/// The shares' devices do the tasks of a queue: run_share() of work(i) for each, [0] in this
/// thread. Waits for all; throws what the queue failed with.
void run_shares(std::vector<DeviceShare>& shares, std::atomic<std::size_t>& left,
                SharedTasks& queue, const std::function<void(std::size_t device)>& work);

}  // namespace kilolux
