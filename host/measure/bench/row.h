// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "host/measure/bench/sweep.h"
#include "host/measure/bench/table.h"
#include "host/measure/metrics/statistics.h"
#include "host/measure/roofline/stage_report.h"

namespace kilolux {

/// A configuration's picture against the all-lights reference of the same G-buffer layout.
struct PictureError {
    double max_relative = 0.0;  // over all channels; where the reference is below its mean, to that
    std::uint64_t different_pixels = 0;  // whose float32 bits differ
    std::uint64_t pixels = 0;            // compared
    bool operator==(const PictureError&) const = default;
};

/// One stage of one point of a sweep, the time outside of the stages, or the whole frame.
struct BenchRow : StageEffort {
    SweepPoint point;
    std::string stage;  // a stage of FrameStats, kOtherStage or kFrameStage
    Statistics ms;
    double k = 0.0;         // lights evaluated a surface pixel
    double useful_k = 0.0;  // k*: of those in range
    PictureError error;

    double ratio() const { return ratio_of(limit_ms, ms.median); }
    double giga_evaluations_per_s() const { return ratio_of(1e-6 * evaluations, ms.median); }
    double gigabytes_per_s() const { return ratio_of(1e-6 * bytes, ms.median); }
    double useful_share() const { return k > 0.0 ? useful_k / k : 1.0; }

    /// Whether the stage was faster than its limit by more than the noise: the limit or the model
    /// is wrong. False for fewer than 10 frames, as their noise is unknown.
    bool beats_limit() const;
};

/// All columns, with rates and ratios.
Table bench_table(const std::vector<BenchRow>& rows);

/// A short table: the fields that vary between the points, and the most important columns.
Table bench_summary(const std::vector<BenchRow>& rows);

/// What the columns of bench_summary() mean, in a few lines.
std::string bench_legend(const std::vector<BenchRow>& rows);

/// Whether a table has bench_table()'s columns; those of shadows, its last, may be missing.
bool is_bench_table(const TextTable& csv);

/// The rows of bench_table() as parse_csv() reads them. Throws Error with the line's number for
/// anything else.
std::vector<BenchRow> bench_rows(const TextTable& csv);

/// The rows without those of a last point whose frame is missing: a copied file may end there.
std::vector<BenchRow> complete_points(std::vector<BenchRow> rows);

/// Names of the fields in which the rows' points differ, and the fields that they share:
/// ", resolution 1920x1080, lights 5000".
std::vector<std::string> varying_fields(const std::vector<BenchRow>& rows);
std::string shared_fields(const std::vector<BenchRow>& rows);

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

    /// Adds a complete point and writes the file. Before the first point of a new file the old one
    /// is removed and `begin` called, so that no row stands beside the context of another run.
    /// Throws Error with the system's reason.
    void append(const std::vector<BenchRow>& rows, const std::function<void()>& begin = {});

 private:
    std::filesystem::path file_;
    std::vector<BenchRow> rows_;
};

}  // namespace kilolux
