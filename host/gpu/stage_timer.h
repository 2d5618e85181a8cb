// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CL/opencl.hpp>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/gpu/idle_time.h"

namespace kilolux {

/// Collects the profiling events of a frame under their stages' names.
class StageTimer {
 public:
    using Clock = std::chrono::steady_clock;

    /// Adds an event to a stage; a stage may have several. Call it when the command was enqueued.
    /// `is_first`: the first launch of a kernel in this work-group size, before which drivers
    /// compile.
    void record(std::string_view stage, const cl::Event& event, bool is_first = false);

    /// Adds a time in which the host waited for a program, as far as it lies after the last take().
    void record_build(Clock::time_point start, Clock::time_point end);

    /// Adds the last `ms` of the host to a stage, as far as the device idled in them.
    void record_host(std::string_view stage, double ms);

    struct Time {
        std::string stage;
        // Of the events' execution on the device, and of the host while the device idled: no
        // moment counts twice.
        double ms = 0.0;
    };

    /// Asks the driver for the times of all commands so far, which take() otherwise does. Blocks
    /// until they are done, one after the other.
    void gather();

    /// Times by stage, those of the host alone first, then in the order of first use; forgets the
    /// events. Blocks until they are done.
    std::vector<Time> take();

    /// Between the last two take(), or from this object's beginning to the first: for how long the
    /// device idled although the next command was enqueued [ms].
    double launch_ms() const;
    /// How long it idled because no command was enqueued [ms]. Both are without the time of
    /// record_host(), and without build_ms() and first_launch_ms().
    double enqueue_ms() const;
    /// How long it idled while programs were built, and before first launches [ms].
    double build_ms() const;
    double first_launch_ms() const;

    /// Forgets the commands that were recorded after the copy `before`, but neither the host's time
    /// nor that before first launches.
    void drop_commands_since(const StageTimer& before) { entries_ = before.entries_; }

 private:
    struct Recorded {
        cl::Event event;
        Clock::time_point time;
        std::optional<CommandSpan> span = {};  // by gather()
    };
    struct Entry {
        std::string stage;
        std::vector<Recorded> events;
    };
    struct HostEntry {
        std::string stage;
        HostSpan span;  // on Clock
    };
    void add_host_times(std::vector<Time>& times) const;

    std::vector<Entry> entries_;
    Clock::time_point since_ = Clock::now();  // start of the idle time that is not yet reported
    std::vector<HostEntry> host_;
    std::vector<HostSpan> builds_;  // on Clock
    std::vector<cl::Event> first_launches_;
    IdleTime idle_;
    std::int64_t build_ = 0, first_launch_ = 0;  // [ns]
};

}  // namespace kilolux
