// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/stage_timer.h"

#include <algorithm>

namespace kilolux {
namespace {

constexpr double kMsPerTick = 1e-6;  // profiling counts nanoseconds

// When a command was enqueued and ran, on the device's clock.
struct Span {
    cl_ulong queued, start, end;
};

Span span_of(const cl::Event& event) {
    return {event.getProfilingInfo<CL_PROFILING_COMMAND_QUEUED>(),
            event.getProfilingInfo<CL_PROFILING_COMMAND_START>(),
            event.getProfilingInfo<CL_PROFILING_COMMAND_END>()};
}

// Gaps between commands, from where the later one was enqueued on.
cl_ulong launch_ticks(std::vector<Span> spans) {
    std::ranges::sort(spans, {}, &Span::start);
    cl_ulong sum = 0;
    for (std::size_t i = 1; i < spans.size(); ++i) {
        const cl_ulong ready = std::max(spans[i - 1].end, spans[i].queued);
        if (spans[i].start > ready) sum += spans[i].start - ready;
    }
    return sum;
}

}  // namespace

void StageTimer::record(std::string_view stage, const cl::Event& event) {
    auto entry = std::find_if(entries_.begin(), entries_.end(),
                              [&](const Entry& e) { return e.stage == stage; });
    if (entry == entries_.end()) entry = entries_.insert(entry, Entry{std::string(stage), {}});
    entry->events.push_back(event);
}

std::vector<StageTimer::Time> StageTimer::take() {
    std::vector<Time> times;
    std::vector<Span> spans;
    for (const Entry& entry : entries_) {
        Time time{entry.stage, 0.0};
        for (const cl::Event& event : entry.events) {
            event.wait();
            spans.push_back(span_of(event));
            time.ms += kMsPerTick * static_cast<double>(spans.back().end - spans.back().start);
        }
        times.push_back(std::move(time));
    }
    entries_.clear();
    launch_ms_ = kMsPerTick * static_cast<double>(launch_ticks(std::move(spans)));
    return times;
}

}  // namespace kilolux
