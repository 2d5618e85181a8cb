// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "host/measure/bench/run.h"
#include "host/measure/report/compare.h"

namespace kilolux {

/// Measures the settings of a report: errors, then times.
class ReportRun : public ReportComparison {
 public:
    using ReportComparison::ReportComparison;

    /// Called when another of steps() is done.
    void on_progress(std::function<void()> call) { on_progress_ = std::move(call); }
    /// Only rows for which `wanted` is true and the first are timed; the others' times are 0, and
    /// `relative` infinite.
    void time_only(std::function<bool(const ReportRow&)> wanted) { time_only_ = std::move(wanted); }
    static std::size_t steps(std::size_t settings) { return settings * (kRounds + 1); }

    /// Measures errors, then times, then finds the Pareto sets. The first setting is the default.
    /// Each frame of another setting is paired with one of the default's, in two rounds over all
    /// settings, so that other load on the machine affects both.
    std::vector<ReportRow> measure(const std::vector<ReportSetting>& settings,
                                   const BenchFrames& frames);

    /// The part of measure() after compare(): times of all rows, on one device, with nothing beside
    /// it.
    std::vector<ReportRow> time(std::vector<ComparedRow> compared, const BenchFrames& frames);

 private:
    static constexpr int kRounds = 2;

    RenderSettings whole_frames(const ReportSetting& setting) const;
    void time_rounds(std::vector<ComparedRow>& compared, const BenchFrames& frames);
    void time_frames(const ReportSetting& setting, const BenchFrames& frames, ReportTiming& timing,
                     ReportTiming* standard);
    void render_into(Renderer& renderer, ReportTiming& timing);
    void count(ReportRow& row, const ReportTiming& timing);
    ReportSpeed speed_of(const ReportRow& row, const ReportTiming& timing) const;

    std::function<void()> on_progress_ = [] {};
    std::function<bool(const ReportRow&)> time_only_ = [](const ReportRow&) { return true; };
    std::map<std::string, FrameStats> coverages_;
    std::optional<Renderer> standard_;  // of the default setting, while frames are timed
};

/// The error by which rows are compared; none: the row is not compared.
using RowError = std::function<std::optional<double>(const ReportRow&)>;
std::optional<double> surfaces_rmse(const ReportRow& row);   // R2, among equal ranges
std::optional<double> unbounded_rmse(const ReportRow& row);  // R3, among the cut-offs
std::optional<double> tails_rmse(const ReportRow& row);      // of `tails`, among the same

/// The Pareto set of frame time and an error, ascending by time. Times differ from kCostResolution
/// or twice their usual noise on, errors from kErrorResolution.
std::vector<std::size_t> front_of(const std::vector<ReportRow>& rows, const RowError& error);

/// Marks the rows of the Pareto sets.
void mark_fronts(std::vector<ReportRow>& rows);

/// The fastest row that beats the default (the first row); none: no row does. A row beats it where
/// it is faster by more than kCostResolution and twice its own noise, and its R2 RMSE is at most
/// kErrorResolution above the default's. One that is slower, or as fast within noise, does not,
/// however exact it is.
const ReportRow* row_that_beats_default(const std::vector<ReportRow>& rows);

}  // namespace kilolux
