// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/parallel_rows.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <mutex>

namespace kilolux {
namespace {

// Tells the thread sanitizer, which does not see how oneTBB hands over work, that rows run after
// what the caller did before, and before what the caller does next.
std::atomic<unsigned> row_order{0};

struct OrderedRow {
    OrderedRow() { row_order.load(std::memory_order_acquire); }
    ~OrderedRow() { row_order.fetch_add(1, std::memory_order_release); }
};

}  // namespace

void parallel_rows(int count, const std::function<void(int)>& body, const OnProgress& progress) {
    std::mutex mutex;  // guards `done` and calls of `progress`
    int done = 0;
    const auto row = [&](int y) {
        const OrderedRow ordered;
        body(y);
        if (!progress) return;
        const std::lock_guard lock(mutex);
        progress(static_cast<double>(++done) / count);
    };
    row_order.fetch_add(1, std::memory_order_release);
    // One row per task: an exception stops the work after the rows that have begun.
    tbb::parallel_for(0, count, row, tbb::simple_partitioner{});
    row_order.load(std::memory_order_acquire);
}

}  // namespace kilolux
