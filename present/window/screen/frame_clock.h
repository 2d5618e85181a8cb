// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

namespace kilolux {

/// The time of the window's frames [s]: measured, or all of one length.
class FrameClock {
 public:
    static constexpr double kUsualSeconds = 1.0 / 60.0;
    static constexpr double kLongestSeconds = 0.25;

    /// Ends the frame's work, before the loop waits for the next.
    void end_frame() { busy_seconds_ = seconds_since(begin_); }

    /// Begins the next frame after a wait of up to `waited`. `fixed`: its length, if given.
    void begin_frame(double waited, std::optional<double> fixed) {
        const double whole = seconds_since(begin_);
        begin_ = Clock::now();
        // After a long wait a key that ended it has been down for one frame at most.
        const double most = waited > kUsualSeconds ? kUsualSeconds : kLongestSeconds;
        frame_seconds_ = fixed.value_or(std::min(whole, most));
        now_ += fixed.value_or(std::min(whole, kLongestSeconds));
    }

    double frame_seconds() const { return frame_seconds_; }
    double busy_seconds() const { return busy_seconds_; }  // of the last frame, without its wait
    double now() const { return now_; }                    // since the first frame

 private:
    using Clock = std::chrono::steady_clock;
    static double seconds_since(Clock::time_point start) {
        return std::chrono::duration<double>(Clock::now() - start).count();
    }

    Clock::time_point begin_ = Clock::now();
    double frame_seconds_ = 0.0;
    double busy_seconds_ = 0.0;
    double now_ = 0.0;
};

}  // namespace kilolux
