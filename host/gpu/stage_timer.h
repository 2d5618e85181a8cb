// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CL/opencl.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace kilolux {

/// Collects the profiling events of a frame under their stages' names.
class StageTimer {
 public:
    /// Adds an event to a stage; a stage may have several.
    void record(std::string_view stage, const cl::Event& event);

    struct Time {
        std::string stage;
        double ms = 0.0;  // sum of the events' execution times on the device
    };

    /// Times by stage in the order of first use, and forgets the events. Blocks until they are
    /// done.
    std::vector<Time> take();

    /// Of the events of the last take(): for how long the device idled although the next one was
    /// enqueued [ms].
    double launch_ms() const { return launch_ms_; }

 private:
    struct Entry {
        std::string stage;
        std::vector<cl::Event> events;
    };
    std::vector<Entry> entries_;
    double launch_ms_ = 0.0;
};

}  // namespace kilolux
