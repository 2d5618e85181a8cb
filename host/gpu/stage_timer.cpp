// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/stage_timer.h"

#include <algorithm>

namespace kilolux {

void StageTimer::record(std::string_view stage, const cl::Event& event) {
    auto entry = std::find_if(entries_.begin(), entries_.end(),
                              [&](const Entry& e) { return e.stage == stage; });
    if (entry == entries_.end()) entry = entries_.insert(entry, Entry{std::string(stage), {}});
    entry->events.push_back(event);
}

std::vector<StageTimer::Time> StageTimer::take() {
    std::vector<Time> times;
    for (const Entry& entry : entries_) {
        Time time{entry.stage, 0.0};
        for (const cl::Event& event : entry.events) {
            event.wait();
            const auto start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
            const auto end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
            time.ms += 1e-6 * static_cast<double>(end - start);
        }
        times.push_back(std::move(time));
    }
    entries_.clear();
    return times;
}

}  // namespace kilolux
