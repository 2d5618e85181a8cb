// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/stage_timer.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace kilolux {
namespace {

constexpr double kMsPerTick = 1e-6;  // profiling counts nanoseconds

std::int64_t ticks(std::chrono::steady_clock::duration time) {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(time).count();
}

// On the device's clock.
CommandSpan span_of(const cl::Event& event) {
    return {static_cast<std::int64_t>(event.getProfilingInfo<CL_PROFILING_COMMAND_QUEUED>()),
            static_cast<std::int64_t>(event.getProfilingInfo<CL_PROFILING_COMMAND_START>()),
            static_cast<std::int64_t>(event.getProfilingInfo<CL_PROFILING_COMMAND_END>())};
}

// When the host began or ended: a command that takes no time.
CommandSpan moment(std::int64_t time) { return {time, time, time}; }

}  // namespace

void StageTimer::record(std::string_view stage, const cl::Event& event, bool is_first) {
    auto entry = std::find_if(entries_.begin(), entries_.end(),
                              [&](const Entry& e) { return e.stage == stage; });
    if (entry == entries_.end()) entry = entries_.insert(entry, Entry{std::string(stage), {}});
    entry->events.push_back({event, Clock::now()});
    if (is_first) first_launches_.push_back(event);
}

void StageTimer::record_build(Clock::time_point start, Clock::time_point end) {
    if (end <= since_) return;
    start = std::max(start, since_);
    builds_.push_back({ticks(start.time_since_epoch()), ticks(end.time_since_epoch())});
}

void StageTimer::record_host(std::string_view stage, double ms) {
    const std::int64_t end = ticks(Clock::now().time_since_epoch());
    host_.push_back({std::string(stage), {end - static_cast<std::int64_t>(ms / kMsPerTick), end}});
}

void StageTimer::gather() {
    for (Entry& entry : entries_) {
        for (Recorded& recorded : entry.events) {
            if (recorded.span) continue;
            recorded.event.wait();
            recorded.span = span_of(recorded.event);
        }
    }
}

std::vector<StageTimer::Time> StageTimer::take() {
    idle_ = {};
    build_ = first_launch_ = 0;
    if (entries_.empty() && host_.empty()) return {};
    gather();
    const Clock::time_point now = Clock::now();
    std::vector<Time> times;
    std::vector<CommandSpan> spans;
    // Offset from the device's clock to the host's: the least difference that a record() shows.
    std::int64_t offset = std::numeric_limits<std::int64_t>::max();
    for (const Entry& entry : entries_) {
        Time& time = times.emplace_back(Time{entry.stage});
        for (const Recorded& recorded : entry.events) {
            const CommandSpan span = *recorded.span;
            spans.push_back(span);
            time.ms += kMsPerTick * static_cast<double>(span.end - span.start);
            offset = std::min(offset, ticks(recorded.time.time_since_epoch()) - span.queued);
        }
    }
    if (entries_.empty()) offset = 0;
    std::vector<HostSpan> host;
    for (const HostEntry& entry : host_) {
        host.push_back({entry.span.start - offset, entry.span.end - offset});
    }
    for (const HostSpan& span : std::exchange(builds_, {})) {
        host.push_back({span.start - offset, span.end - offset});
    }
    const std::size_t builds_end = host.size();
    for (const cl::Event& event : std::exchange(first_launches_, {})) {
        event.wait();  // of a command that was dropped, too
        const CommandSpan span = span_of(event);
        host.push_back({span.queued, span.start});
    }
    for (const Clock::time_point end : {std::exchange(since_, now), now}) {
        spans.push_back(moment(ticks(end.time_since_epoch()) - offset));
    }
    idle_ = idle_time(std::move(spans), host);
    const auto sum = [this](std::size_t first, std::size_t last) {
        const auto begin = idle_.host.begin();
        return std::accumulate(begin + static_cast<std::ptrdiff_t>(first),
                               begin + static_cast<std::ptrdiff_t>(last), std::int64_t{0});
    };
    build_ = sum(host_.size(), builds_end);
    first_launch_ = sum(builds_end, host.size());
    add_host_times(times);
    entries_.clear();
    host_.clear();
    return times;
}

void StageTimer::add_host_times(std::vector<Time>& times) const {
    std::size_t first = 0;  // the place of the next stage that only the host runs
    for (std::size_t i = 0; i < host_.size(); ++i) {
        auto found = std::ranges::find(times, host_[i].stage, &Time::stage);
        if (found == times.end()) {
            const auto place = times.begin() + static_cast<std::ptrdiff_t>(first++);
            found = times.insert(place, Time{host_[i].stage});
        }
        found->ms += kMsPerTick * static_cast<double>(idle_.host[i]);
    }
}

double StageTimer::launch_ms() const { return kMsPerTick * static_cast<double>(idle_.launch); }

double StageTimer::enqueue_ms() const { return kMsPerTick * static_cast<double>(idle_.enqueue); }

double StageTimer::build_ms() const { return kMsPerTick * static_cast<double>(build_); }

double StageTimer::first_launch_ms() const {
    return kMsPerTick * static_cast<double>(first_launch_);
}

}  // namespace kilolux
