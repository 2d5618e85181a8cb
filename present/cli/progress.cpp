// SPDX-License-Identifier: Apache-2.0
#include "present/cli/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "host/base/error.h"

namespace kilolux {
namespace {

int terminal_columns() {
    winsize size = {};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
    return size.ws_col;
}

bool is_of_farm(ProgressKind kind) { return !farm_line(kind, 0.0).empty(); }

double share_of(std::size_t done, std::size_t total) {
    return total == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(total);
}

}  // namespace

std::string duration_text(double seconds) {
    const auto whole = static_cast<long long>(std::ceil(seconds));
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
    return fmt::format("{}:{:02} h", whole / 3600, whole / 60 % 60);
}

std::string progress_line(const std::string& label, std::size_t done, std::size_t total,
                          double elapsed_s, int width) {
    const double share = share_of(done, total);
    const std::string head = fmt::format("{} {}/{} ", label, done, total);
    std::string tail = fmt::format("{:3} %", static_cast<int>(share * 100.0));
    if (done > 0 && done < total) {
        tail += fmt::format(", {} left", duration_text(elapsed_s * (1.0 / share - 1.0)));
    }
    if (done == 0 && elapsed_s >= 1.0) tail += fmt::format(", {} so far", duration_text(elapsed_s));
    const int room = std::min(width - static_cast<int>(head.size() + tail.size()) - 3, 40);
    // A bar of fewer than eight columns shows too little.
    if (room < 8) return (head + tail).substr(0, static_cast<std::size_t>(std::max(width, 0)));
    const auto filled = static_cast<std::size_t>(share * room);
    const auto empty = static_cast<std::size_t>(room) - filled;
    return fmt::format("{}[{:=<{}}{: <{}}] {}", head, "", filled, "", empty, tail);
}

ProgressKind progress_kind(ProgressKind asked, bool quiet) {
    return quiet && asked == ProgressKind::automatic ? ProgressKind::none : asked;
}

ProgressKind progress_kind_of_part(ProgressKind kind) {
    return is_of_farm(kind) ? ProgressKind::none : kind;
}

void check_progress(ProgressKind kind, bool prints_result) {
    if (!prints_result || !is_of_farm(kind)) return;
    throw UsageError(
        "--progress: its lines would stand in the result on standard output; write that "
        "to a file");
}

std::string farm_line(ProgressKind kind, double share) {
    // Rounded down: unfinished work never shows 100.
    if (kind == ProgressKind::openjd)
        return fmt::format("openjd_progress: {:.1f}", std::floor(1000.0 * share) / 10.0);
    if (kind == ProgressKind::alf)
        return fmt::format("ALF_PROGRESS {}%", static_cast<int>(100.0 * share));
    return "";
}

Progress::Progress(std::string label, std::size_t total, ProgressKind kind, double line_s)
    : label_(std::move(label)),
      total_(total),
      kind_(kind),
      has_bar_(kind == ProgressKind::automatic && isatty(STDERR_FILENO) == 1),
      line_s_(line_s),
      next_line_s_(is_of_farm(kind) ? 0.0 : line_s) {
    draw();
    if (kind_ == ProgressKind::none || has_bar_) return;
    lines_ = std::jthread([this](const std::stop_token& end) { draw_lines(end); });
}

Progress::~Progress() { erase(); }

void Progress::advance() {
    const std::scoped_lock lock(mutex_);
    ++done_;
    if (is_of_farm(kind_)) next_line_s_ = 0.0;
    draw();
}

void Progress::draw_lines(const std::stop_token& end) {
    constexpr double kLeast = 0.01;
    std::unique_lock lock(mutex_);
    while (!end.stop_requested()) {
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
        const std::chrono::duration<double> left(std::max(next_line_s_ - elapsed.count(), kLeast));
        ended_.wait_for(lock, end, left, [] { return false; });
        if (!end.stop_requested()) draw();
    }
}

void Progress::erase() {
    if (has_bar_) std::fputs("\r\x1b[K", stderr);
}

void Progress::draw() {
    if (kind_ == ProgressKind::none) return;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    if (has_bar_) return draw_bar(elapsed.count());
    if (elapsed.count() < next_line_s_) return;
    next_line_s_ = elapsed.count() + line_s_;
    if (is_of_farm(kind_)) {
        std::printf("%s\n", farm_line(kind_, share_of(done_, total_)).c_str());
        std::fflush(stdout);
        return;
    }
    constexpr int kColumns = 79;
    std::fprintf(stderr, "%s\n",
                 progress_line(label_, done_, total_, elapsed.count(), kColumns).c_str());
}

void Progress::draw_bar(double elapsed_s) const {
    // The last column stays free: writing it makes some terminals wrap.
    const std::string line =
        progress_line(label_, done_, total_, elapsed_s, terminal_columns() - 1);
    std::fprintf(stderr, "\r\x1b[K%s", line.c_str());
    std::fflush(stderr);
}

}  // namespace kilolux
