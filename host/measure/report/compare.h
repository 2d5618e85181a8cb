// SPDX-License-Identifier: Apache-2.0
#pragma once

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
    HdrMetrics
        rasterised;  // against float64 shading of what the rasteriser drew, nothing quantised
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

/// Measures the errors of a report's settings over one view of a scene: its first part.
class ReportComparison {
 public:
    /// `base`: the settings asked for, at full size. `limits`: of the size of the comparison.
    ReportComparison(const ReportView& view, const RenderSettings& base,
                     const ErrorSizeLimits& limits = {});

    /// Called often, also from worker threads while a reference is made; may throw to stop.
    void on_step(std::function<void()> call);

    /// Threads may call it at once, each with a device of its own; devices that compute alike make
    /// the same errors.
    ComparedRow compare(const ReportSetting& setting, const ReportDevice& device);
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

 protected:
    void step() const { on_step_(); }
    const ReportView& view() const { return view_; }

 private:
    Frame picture_of(Renderer& renderer, const ReportSetting& setting);
    ReportTiming timing_of(const ReportSetting& setting, const FrameStats& compared,
                           const ReportDevice& device);
    double expected_ms(const RenderSettings& whole, double compared_ms, const ReportDevice& device);
    std::optional<ErrorEstimate> estimated_error(const ReportRow& row, Renderer& renderer,
                                                 const ReportDevice& device);

    ReportView view_;
    ReportDevice device_;  // of all settings: most of their programs are the same
    std::array<int, 2> error_size_;
    ReportReferences references_;
    std::function<void()> on_step_ = [] {};
};

double pixels_of(const RenderSettings& settings);

/// Time of a frame [ms] of `pixels`, by a straight line through two smaller frames of increasing
/// size; at least the larger one's.
struct TimedFrame {
    double pixels = 0.0, ms = 0.0;
};
double extrapolated_ms(const TimedFrame& small, const TimedFrame& larger, double pixels);

}  // namespace kilolux
