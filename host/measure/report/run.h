// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/measure/bench/run.h"
#include "host/measure/metrics/error_size.h"
#include "host/measure/metrics/statistics.h"
#include "host/measure/report/estimated_error.h"
#include "host/measure/report/references.h"
#include "host/measure/report/setting.h"
#include "host/render/renderer.h"

namespace kilolux {

/// Time of a stage in the frames of a setting.
struct ReportStage {
    std::string name;
    Statistics ms;
};

/// A setting's speed. Times are medians over frames, the whole frame's by the host's clock.
struct ReportSpeed {
    bool scaled = false;  // too slow at full size: timed at the size of the comparison, per pixel
    std::vector<ReportStage> stages;  // in the frame's order
    // The default's median times `relative`, so that other load on the machine shifts all alike.
    double frame_ms = 0.0;
    std::size_t frames = 0;
    // Ratio to the default's frame time, of frames rendered in pairs: median, 5 % and 95 %.
    double relative = 1.0, relative_p5 = 1.0, relative_p95 = 1.0;
    double noise = 0.0;              // of that median, relative, from the scatter of the pairs
    double k = -1.0;                 // lights evaluated per surface pixel; < 0: not counted
    double useful_k = -1.0;          // k*: those of them in range
    double evaluations_per_s = 0.0;  // of the stage that shades
};

/// A row of a report: a setting's cost and errors.
struct ReportRow {
    ReportSetting setting;
    double cut_off = 0.0;  // see cut_off_of()
    ReportSpeed speed;
    PictureErrors kernels, surfaces, unbounded;  // against R1, R2, R3
    HdrMetrics drawn;  // against float64 shading of what the rasteriser drew, nothing quantised
    std::optional<std::uint64_t> missed_lights;
    HdrMetrics tails;                       // where lights lack a range: against unlimited()
    std::optional<ErrorEstimate> estimate;  // see estimate_error(): against the same
    RgbImage picture;                       // linear, at the size of the comparison
    std::vector<std::uint8_t> display;      // its sRGB codes
    bool surfaces_front = false;     // in the Pareto set of time and R2's RMSE, among equal ranges
    bool unbounded_front = false;    // in that of time and R3's RMSE, among the cut-offs
    bool tails_front = false;        // in that of time and the RMSE of `tails`, among the same
    std::shared_ptr<const Gpu> gpu;  // that made `picture`
};

/// A setting's frames before they are summarised.
struct ReportTiming {
    double expected_ms = 0.0;  // of a frame at full size
    bool scaled = false;
    FrameStats stats;  // of the last frame
    std::vector<StageTime> stages;
    std::vector<double> frames;
    std::vector<double> relative;  // to the default's frame before or after
};

/// A row with its errors; its time is only estimated.
struct ComparedRow {
    ReportRow row;
    ReportTiming timing;
};

/// Measures the settings of a report over one view of a scene.
class ReportRun {
 public:
    /// `base`: the settings asked for, at full size. `limits`: of the size of the comparison.
    ReportRun(const ReportView& view, const RenderSettings& base,
              const ErrorSizeLimits& limits = {});

    /// Called often, also from worker threads while a reference is made; may throw to stop.
    void on_step(std::function<void()> call);
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

    /// The parts of measure(), for several devices. Threads may call compare() at once, each with a
    /// device of its own; devices that compute alike make the same errors.
    ComparedRow compare(const ReportSetting& setting, const ReportDevice& device);
    /// Measures the times of all rows, on one device, with nothing beside it.
    std::vector<ReportRow> time(std::vector<ComparedRow> compared, const BenchFrames& frames);
    /// Estimates the time of a slow setting anew: other devices worked while it was compared.
    void estimate_again(ComparedRow& compared);
    const ReportDevice& device() const { return device_; }
    /// Times are measured on this device from now on, instead of that of the settings asked for.
    void move_to(ReportDevice device) { device_ = std::move(device); }

    ReportReferences& references() { return references_; }
    /// Size of the comparison [pixel].
    std::array<int, 2> error_size() const { return error_size_; }
    /// The settings of the comparison: at that size, on the device of the report or of the row.
    RenderSettings at_error_size(RenderSettings settings) const;
    RenderSettings at_error_size(const ReportRow& row) const;

 private:
    static constexpr int kRounds = 2;

    Frame picture_of(Renderer& renderer, const ReportSetting& setting);
    RenderSettings whole_frames(const ReportSetting& setting) const;
    ReportTiming timing_of(const ReportSetting& setting, const FrameStats& compared,
                           const ReportDevice& device);
    double expected_ms(const RenderSettings& whole, double compared_ms, const ReportDevice& device);
    std::optional<ErrorEstimate> estimated_error(const ReportRow& row, Renderer& renderer,
                                                 const ReportDevice& device);
    void time_rounds(std::vector<ComparedRow>& compared, const BenchFrames& frames);
    void time_frames(const ReportSetting& setting, const BenchFrames& frames, ReportTiming& timing,
                     ReportTiming* standard);
    void render_into(Renderer& renderer, ReportTiming& timing);
    void count(ReportRow& row, const ReportTiming& timing);
    ReportSpeed speed_of(const ReportRow& row, const ReportTiming& timing) const;

    ReportView view_;
    ReportDevice device_;  // of all settings: most of their programs are the same
    std::array<int, 2> error_size_;
    ReportReferences references_;
    std::function<void()> on_step_ = [] {};
    std::function<void()> on_progress_ = [] {};
    std::function<bool(const ReportRow&)> time_only_ = [](const ReportRow&) { return true; };
    std::map<std::string, FrameStats> coverages_;
    std::optional<Renderer> standard_;  // of the default setting, while frames are timed
};

double pixels_of(const RenderSettings& settings);

/// Time of a frame [ms] of `pixels`, by a straight line through two smaller frames of increasing
/// size; at least the larger one's.
struct TimedFrame {
    double pixels = 0.0, ms = 0.0;
};
double extrapolated_ms(const TimedFrame& small, const TimedFrame& larger, double pixels);

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
