// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

namespace kilolux {

/// "42 s", "3:05 min", "1:20 h"
std::string duration_text(double seconds);

/// One line of at most `width` columns: label, count, bar, per cent and the time left by the pace
/// so far, or the time so far where nothing is done.
std::string progress_line(const std::string& label, std::size_t done, std::size_t total,
                          double elapsed_s, int width);

/// A progress bar on stderr while stderr is a terminal, erased when it ends; otherwise a line every
/// `line_s` seconds, also while one step takes longer.
class Progress {
 public:
    /// `shown` is false with --quiet.
    Progress(std::string label, std::size_t total, bool shown, double line_s = 30.0);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// One more of `total` is done.
    void advance();

    /// Erases the bar for a message; the next advance() draws it again.
    void erase();

 private:
    void draw();
    void draw_lines(const std::stop_token& end);

    std::string label_;
    std::size_t done_ = 0;
    std::size_t total_;
    bool shown_;
    double line_s_;
    double next_line_s_ = line_s_;
    bool terminal_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::mutex mutex_;  // guards what `lines_` reads
    std::condition_variable_any ended_;
    std::jthread lines_;  // off a terminal
};

}  // namespace kilolux
