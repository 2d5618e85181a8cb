// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "host/measure/bench/row.h"

namespace kilolux {

/// The CSV of a sweep. It is written whole after every point, so that an interruption loses one
/// point at most.
class BenchLog {
 public:
    /// `resume`: keep the complete points of the file. Otherwise the first append() replaces it.
    /// Throws Error for a file that is no such log.
    BenchLog(std::filesystem::path file, bool resume);

    /// Rows of the complete points.
    const std::vector<BenchRow>& rows() const { return rows_; }

    /// The rows of a point; empty if it is not there.
    std::vector<BenchRow> rows_of(const SweepPoint& point) const;

    /// Adds a complete point and writes the file. Throws Error with the system's reason.
    void append(const std::vector<BenchRow>& rows);

 private:
    std::filesystem::path file_;
    std::vector<BenchRow> rows_;
};

}  // namespace kilolux
