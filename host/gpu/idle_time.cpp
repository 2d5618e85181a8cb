// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/idle_time.h"

#include <algorithm>

namespace kilolux {
namespace {

// The time from `from` to `to` that no host span covers. Spans by their start.
std::int64_t without(const std::vector<HostSpan>& host, std::int64_t from, std::int64_t to) {
    std::int64_t left = 0;
    for (const HostSpan& span : host) {
        if (span.start >= to) break;
        left += std::max<std::int64_t>(span.start - from, 0);
        from = std::max(from, span.end);
    }
    return left + std::max<std::int64_t>(to - from, 0);
}

}  // namespace

IdleTime idle_time(std::vector<CommandSpan> commands, std::vector<HostSpan> host) {
    std::ranges::sort(commands, {}, &CommandSpan::start);
    std::ranges::sort(host, {}, &HostSpan::start);
    IdleTime out;
    const std::int64_t begin = commands.empty() ? 0 : commands.front().start;
    std::int64_t done = begin, counted = 0;
    for (const CommandSpan& command : commands) {
        const std::int64_t idle_from = done, next = command.start;
        done = std::max(done, command.end);
        counted += command.end - command.start;
        if (next <= idle_from) continue;
        const std::int64_t ready = std::clamp(command.queued, idle_from, next);
        out.launch += without(host, ready, next);
        out.enqueue += without(host, idle_from, ready);
    }
    for (const HostSpan& span : host) counted += span.end - span.start;
    out.overlap = counted + out.launch + out.enqueue - (done - begin);
    return out;
}

}  // namespace kilolux
