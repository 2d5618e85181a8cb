// SPDX-License-Identifier: Apache-2.0
// A report's settings, measured by several devices.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/measure/report/run.h"
#include "present/commands/devices/device_share.h"

namespace kilolux {

/// Rows in the order of the settings, and each device's part.
struct SharedReport {
    std::vector<ReportRow> rows;
    std::vector<DeviceShare> shares;
};

/// What is measured.
struct ReportJob {
    const ReportView& view;
    const std::vector<ReportSetting>& settings;
    BenchFrames frames;
    std::function<void()> on_progress;  // called ReportRun::steps() times, by one thread at a time
};

/// ReportRun::measure() on the devices with these indices. The first is the run's own. Errors are
/// measured by all at once, the next setting's by whichever is free. Times are measured afterwards
/// on the first device that has not failed, so that they have one unit and nothing beside them. A
/// device that fails is left out with one line; others measure its settings again. Throws its error
/// where none is left.
SharedReport measure_on(const std::vector<std::string>& devices, ReportRun& run,
                        const ReportJob& job);

/// "device 0 (its name): errors of 7 settings, all times", a line a device.
std::string device_lines(const std::vector<DeviceShare>& shares);

/// The list of the report's context.
nlohmann::ordered_json devices_json(const std::vector<DeviceShare>& shares);

}  // namespace kilolux
