// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "present/window/app/cluster_view.h"
#include "present/window/panel/panel.h"

namespace kilolux {

/// What the worker's jobs found out, until the window takes it.
struct SessionNews {
    std::mutex mutex;
    std::optional<DeviceLimits> limits;
    std::optional<std::string> message;
    std::optional<ProbedPixel> probed;
    std::optional<FrozenClusters> frozen;
    bool probe_done = false;  // with or without a result

    void take(PanelFacts& facts) {
        const std::lock_guard lock(mutex);
        if (limits) facts.limits = *limits;
        if (message) facts.message = *message;
        limits.reset();
        message.reset();
    }
};

}  // namespace kilolux
