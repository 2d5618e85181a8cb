// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <utility>
#include <vector>

namespace kilolux {

/// Keeps used objects, so that others take over their memory: allocating and clearing a large array
/// takes as long as filling it. Any thread may call these functions.
template <typename T>
class Spares {
 public:
    void give(T spare) {
        const std::scoped_lock lock(mutex_);
        spares_.push_back(std::move(spare));
    }

    /// A used object with its old contents, or a new one where there is none.
    T take() {
        const std::scoped_lock lock(mutex_);
        if (spares_.empty()) return {};
        T out = std::move(spares_.back());
        spares_.pop_back();
        return out;
    }

 private:
    std::mutex mutex_;
    std::vector<T> spares_;
};

}  // namespace kilolux
