// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "host/measure/bench/row.h"

namespace kilolux {

/// The CSV of a sweep that grows point by point, so that an interruption loses one point at most.
class BenchLog {
 public:
    /// `resume`: go on with what the file holds; rows of a point that is not complete (its frame
    /// row is missing, or its last line is cut off) do not count and are overwritten. Otherwise the
    /// file is replaced by the first append(). Throws Error for a file that is no such log.
    BenchLog(std::filesystem::path file, bool resume);

    /// Complete points' rows of the file as it was found, of any context.
    const std::vector<BenchRow>& found() const { return found_; }

    /// The rows of a point measured with `context`; empty if it is not there.
    std::vector<BenchRow> rows_of(const SweepPoint& point, const std::string& context) const;

    /// Adds one complete point, all lines in one write that reaches the disk. Throws Error with the
    /// system's reason.
    void append(const std::vector<BenchRow>& rows);

 private:
    std::filesystem::path file_;
    std::vector<BenchRow> found_;
    std::uintmax_t kept_bytes_ = 0;  // of complete points
    bool started_ = false;
};

}  // namespace kilolux
