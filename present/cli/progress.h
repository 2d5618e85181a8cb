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

/// How progress is shown: automatic is a bar on a terminal, else plain lines on stderr; openjd and
/// alf are the lines that Open Job Description and Tractor read on stdout.
enum class ProgressKind { automatic, plain, openjd, alf, none };

/// The kind for a command with or without --quiet.
ProgressKind progress_kind(ProgressKind asked, bool quiet);

/// The kind for a part of a job: a farm reads that of the job alone.
ProgressKind progress_kind_of_part(ProgressKind kind);

/// Throws UsageError where lines for a farm would stand in a result on standard output.
void check_progress(ProgressKind kind, bool prints_result);

/// The line for a farm, or "" where `kind` has none. `share`: 0 to 1.
std::string farm_line(ProgressKind kind, double share);

/// Tells how far a job is: by a bar, which is erased at the end, or by a line every `line_s`
/// seconds, also during a long step. A farm gets a line at each step, too.
class Progress {
 public:
    Progress(std::string label, std::size_t total, ProgressKind kind, double line_s = 10.0);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// One more of `total` is done.
    void advance();

    /// Erases the bar for a message; the next advance() draws it again.
    void erase();

 private:
    void draw();
    void draw_bar(double elapsed_s) const;
    void draw_lines(const std::stop_token& end);

    std::string label_;
    std::size_t done_ = 0;
    std::size_t total_;
    ProgressKind kind_;
    bool has_bar_;
    double line_s_;
    double next_line_s_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::mutex mutex_;  // guards what `lines_` reads
    std::condition_variable_any ended_;
    std::jthread lines_;  // off a terminal
};

}  // namespace kilolux
