// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/parallel_rows.h"

#include <mutex>
#include "host/base/system/parallel.h"

namespace kilolux {

void parallel_rows(int count, const std::function<void(int)>& body, const OnProgress& progress) {
    std::mutex mutex;  // guards `done` and calls of `progress`
    int done = 0;
    const auto row = [&](int y) {
        body(y);
        if (!progress) return;
        const std::lock_guard lock(mutex);
        progress(static_cast<double>(++done) / count);
    };
    parallel_tasks(count, row);
}

}  // namespace kilolux
