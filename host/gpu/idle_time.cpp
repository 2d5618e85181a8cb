// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/idle_time.h"

#include <algorithm>
#include <numeric>

namespace kilolux {
namespace {

// Gives the host spans their parts of the device's idling from `from` to `to`. Returns the rest.
std::int64_t share_out(const std::vector<HostSpan>& host, const std::vector<std::size_t>& by_start,
                       std::int64_t from, std::int64_t to, std::vector<std::int64_t>& parts) {
    std::int64_t left = 0;
    for (const std::size_t i : by_start) {
        if (host[i].start >= to) break;
        left += std::max<std::int64_t>(host[i].start - from, 0);
        from = std::max(from, host[i].start);
        parts[i] += std::max<std::int64_t>(std::min(host[i].end, to) - from, 0);
        from = std::max(from, host[i].end);
    }
    return left + std::max<std::int64_t>(to - from, 0);
}

}  // namespace

IdleTime idle_time(std::vector<CommandSpan> commands, const std::vector<HostSpan>& host) {
    std::ranges::sort(commands, {}, &CommandSpan::start);
    std::vector<std::size_t> by_start(host.size());
    std::iota(by_start.begin(), by_start.end(), std::size_t{0});
    std::ranges::sort(by_start, {}, [&host](std::size_t i) { return host[i].start; });
    IdleTime out;
    out.host.resize(host.size());
    std::int64_t done = commands.empty() ? 0 : commands.front().start;
    for (const CommandSpan& command : commands) {
        const std::int64_t idle_from = done, next = command.start;
        done = std::max(done, command.end);
        if (next <= idle_from) continue;
        const std::int64_t ready = std::clamp(command.queued, idle_from, next);
        out.enqueue += share_out(host, by_start, idle_from, ready, out.host);
        out.launch += share_out(host, by_start, ready, next, out.host);
    }
    return out;
}

}  // namespace kilolux
