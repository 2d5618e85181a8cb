// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <utility>
#include <vector>

namespace kilolux {

/// Things that are done with, whose memory serves again: to get large arrays from the system and to
/// clear them takes as long as to fill them. All functions may be called by any thread.
template <typename T>
class Spares {
 public:
    void give(T spare) {
        const std::scoped_lock lock(mutex_);
        spares_.push_back(std::move(spare));
    }

    /// One that was given, as it was then; a new one where there is none.
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
