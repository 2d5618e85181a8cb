// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kilolux {

/// Calls of OpenCL that this program has made.
struct ClCalls {
    int launches = 0;        // of kernels
    int blocking_reads = 0;  // of buffers
    int finishes = 0;        // of queues

    ClCalls operator-(const ClCalls& before) const {
        return {launches - before.launches, blocking_reads - before.blocking_reads,
                finishes - before.finishes};
    }
};

/// Those so far, of all threads. A program that calls this makes them through functions that count.
ClCalls cl_calls();

}  // namespace kilolux
