// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/parallel_rows.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace kilolux {
namespace {

// What the threads of one call share.
struct Rows {
    Rows(int row_count, const std::function<void(int)>& row_body, const OnProgress& told)
        : count(row_count), body(row_body), progress(told) {}
    const int count;
    const std::function<void(int)>& body;
    const OnProgress& progress;
    std::atomic<int> next{0};
    std::atomic<bool> stop{false};
    std::mutex mutex;  // guards the two below and calls of `progress`
    int done = 0;
    std::exception_ptr failure;
};

void report(Rows& rows) {
    if (!rows.progress) return;
    const std::lock_guard lock(rows.mutex);
    ++rows.done;
    if (!rows.failure) rows.progress(static_cast<double>(rows.done) / rows.count);
}

void fail(Rows& rows, std::exception_ptr failure) {
    rows.stop = true;
    const std::lock_guard lock(rows.mutex);
    if (!rows.failure) rows.failure = std::move(failure);
}

void work(Rows& rows) {
    try {
        while (!rows.stop) {
            const int row = rows.next++;
            if (row >= rows.count) return;
            rows.body(row);
            report(rows);
        }
    } catch (...) {
        fail(rows, std::current_exception());
    }
}

}  // namespace

void parallel_rows(int count, const std::function<void(int)>& body, const OnProgress& progress) {
    Rows rows(count, body, progress);
    const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    {
        std::vector<std::jthread> others;
        for (int i = 1; i < std::min(cores, count); ++i) {
            others.emplace_back([&rows] { work(rows); });
        }
        work(rows);
    }
    if (rows.failure) std::rethrow_exception(rows.failure);
}

}  // namespace kilolux
