// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <exception>
#include <functional>
#include <future>
#include <string>
#include <utility>

namespace kilolux {

/// Receives the message of a task that failed.
using OnFailure = std::function<void(const std::string&)>;

/// The result of a task, from its request until it is taken.
template <typename T>
class Awaited {
 public:
    Awaited() = default;
    explicit Awaited(std::future<T> result) : result_(std::move(result)) {}

    /// Whether a task is under way.
    bool is_open() const { return result_.valid(); }

    /// Passes the result to `take` once it is there. Where the task, or `take`, has failed,
    /// `failed` gets the message; then returns false.
    template <typename Take>
    bool take(Take take, const OnFailure& failed) {
        if (!is_open() || result_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
            return true;
        }
        std::future<T> ready = std::move(result_);
        try {
            take(ready.get());
            return true;
        } catch (const std::exception& error) {
            failed(error.what());
            return false;
        }
    }

 private:
    std::future<T> result_;
};

}  // namespace kilolux
