// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/idle_time.h"

#include <algorithm>

namespace kilolux {

IdleTime idle_time(std::vector<CommandSpan> commands, const std::vector<HostSpan>& host) {
    std::ranges::sort(commands, {}, &CommandSpan::start);
    IdleTime out;
    for (std::size_t i = 1; i < commands.size(); ++i) {
        const std::int64_t done = commands[i - 1].end;
        const std::int64_t next = commands[i].start;
        if (next <= done) continue;
        const std::int64_t ready = std::clamp(commands[i].queued, done, next);
        out.launch += next - ready;
        out.enqueue += ready - done;
        for (const HostSpan& span : host) {
            const std::int64_t from = std::max(span.start, done);
            out.enqueue -= std::max<std::int64_t>(std::min(span.end, ready) - from, 0);
        }
    }
    return out;
}

}  // namespace kilolux
