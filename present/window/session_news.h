// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "present/window/panel.h"

namespace kilolux {

/// What the worker's jobs found out, until the window takes it.
struct SessionNews {
    std::mutex mutex;
    std::optional<DeviceInfo> device;
    std::optional<ScenePlan> plan;
    std::optional<DeviceLimits> limits;
    std::optional<std::uint64_t> device_bytes;
    std::optional<std::string> message;

    void take(PanelFacts& facts) {
        const std::lock_guard lock(mutex);
        if (device) facts.device = *device;
        if (plan) facts.plan = *plan;
        if (limits) facts.limits = *limits;
        if (device_bytes) facts.device_bytes = *device_bytes;
        if (message) facts.message = *message;
        device.reset();
        plan.reset();
        limits.reset();
        device_bytes.reset();
        message.reset();
    }
};

}  // namespace kilolux
