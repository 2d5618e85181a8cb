// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "host/measure/bench/run.h"
#include "host/measure/metrics/statistics.h"
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
    bool scaled = false;  // too slow to time at full size: by the pixels, from the comparison's
    std::vector<ReportStage> stages;  // in the frame's order
    Statistics frame_ms;
    double relative = 1.0;   // to the default's frame: the median over frames rendered in turn
    double noise = 0.0;      // of that median, relative, as the pairs scatter
    double k = -1.0;         // lights evaluated a drawn pixel; < 0: not counted
    double useful_k = -1.0;  // k*: of them in range
    double evaluations_per_s = 0.0;  // of the stage that shades
};

/// A row of a report: what a setting costs and how wrong its picture is.
struct ReportRow {
    ReportSetting setting;
    double cut_off = 0.0;  // radiance that its lights' ranges take; 0: no generated lights
    ReportSpeed speed;
    PictureErrors kernels, surfaces, unbounded;  // against R1, R2, R3
    HdrMetrics drawn;  // against float64 shading of what the rasteriser drew, nothing quantised
    std::optional<std::uint64_t> missed_lights;
    RgbImage picture;                   // linear, at the size of the comparison
    std::vector<std::uint8_t> display;  // its sRGB codes
    bool surfaces_front = false;   // in the Pareto set of time and R2's RMSE, among equal ranges
    bool unbounded_front = false;  // in that of time and R3's RMSE, among the cut-offs
};

/// Measures the settings of a report over one view of a scene.
class ReportRun {
 public:
    /// `base`: the settings asked for, at full size.
    ReportRun(const ReportView& view, const RenderSettings& base);

    /// Called often, also from worker threads while a reference is made; may throw to stop.
    void on_step(std::function<void()> call);
    /// Called when another of steps() is done.
    void on_progress(std::function<void()> call) { on_progress_ = std::move(call); }
    /// Only rows of which `wanted` is true get times; the others' are 0, with `relative` infinite.
    /// The first is always timed.
    void time_only(std::function<bool(const ReportRow&)> wanted) { time_only_ = std::move(wanted); }
    static std::size_t steps(std::size_t settings) { return settings * (kRounds + 1); }

    /// Errors of all settings, then their times, then the Pareto sets. The first setting is the
    /// default. Each frame of another is timed together with one of the default's, in two rounds
    /// over all settings, so that what slows the machine slows both.
    std::vector<ReportRow> measure(const std::vector<ReportSetting>& settings,
                                   const BenchFrames& frames);

    /// The references, as far as measure() needed them.
    ReportReferences& references() { return references_; }
    /// Size of the comparison: at most 320 pixels wide, a few seconds of float64 [pixel].
    std::array<int, 2> error_size() const { return error_size_; }
    /// The settings as they are compared: at that size and without bloom, which is display's.
    RenderSettings at_error_size(RenderSettings settings) const;

 private:
    static constexpr int kRounds = 2;
    struct Timing;

    ReportRow compare(const ReportSetting& setting, Timing& timing);
    void time_frames(const ReportSetting& setting, const BenchFrames& frames, Timing& timing,
                     Timing* standard);
    void render_into(Renderer& renderer, Timing& timing);
    void count(ReportRow& row, const Timing& timing);
    ReportSpeed speed_of(const ReportRow& row, const Timing& timing) const;

    ReportView view_;
    RenderSettings base_;
    std::array<int, 2> error_size_;
    ReportReferences references_;
    std::function<void()> on_step_ = [] {};
    std::function<void()> on_progress_ = [] {};
    std::function<bool(const ReportRow&)> time_only_ = [](const ReportRow&) { return true; };
    std::map<std::string, FrameStats> coverages_;
    std::optional<Renderer> standard_;  // of the default setting, while frames are timed
};

/// Marks the rows of both Pareto sets.
void mark_fronts(std::vector<ReportRow>& rows);

}  // namespace kilolux
