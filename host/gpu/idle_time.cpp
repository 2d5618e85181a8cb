// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/idle_time.h"

#include <algorithm>

namespace kilolux {

IdleTime idle_time(std::vector<CommandSpan> commands, const std::vector<HostSpan>& host) {
    std::ranges::sort(commands, {}, &CommandSpan::start);
    IdleTime out;
    std::int64_t done = commands.empty() ? 0 : commands.front().start;
    for (const CommandSpan& command : commands) {
        const std::int64_t idle_from = done, next = command.start;
        done = std::max(done, command.end);
        if (next <= idle_from) continue;
        const std::int64_t ready = std::clamp(command.queued, idle_from, next);
        out.launch += next - ready;
        out.enqueue += ready - idle_from;
        for (const HostSpan& span : host) {
            const std::int64_t from = std::max(span.start, idle_from);
            out.enqueue -= std::max<std::int64_t>(std::min(span.end, ready) - from, 0);
        }
    }
    return out;
}

}  // namespace kilolux
