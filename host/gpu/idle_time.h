// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace kilolux {

/// A command of the device, all three on one clock [ns].
struct CommandSpan {
    std::int64_t queued, start, end;
};

/// Host work under a stage's name, on the same clock [ns].
struct HostSpan {
    std::int64_t start, end;
};

/// How long a device idled between its commands: outside host spans, and in each of them [ns].
struct IdleTime {
    std::int64_t launch = 0;         // although the next command was enqueued
    std::int64_t enqueue = 0;        // before the next command was enqueued
    std::vector<std::int64_t> host;  // by host span: its part in which the device idled
};

/// Spans in any order. Where host spans overlap, the time is that of the one that began first.
IdleTime idle_time(std::vector<CommandSpan> commands, const std::vector<HostSpan>& host);

}  // namespace kilolux
