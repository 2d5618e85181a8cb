// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/run.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "host/measure/metrics/pareto.h"
#include "host/measure/roofline/stages.h"

namespace kilolux {
namespace {

constexpr double kSettingMs = 10000.0;    // for the frames of a setting in a round
constexpr double kSlowFrameMs = 20000.0;  // slower frames are not timed at full size
constexpr int kLargerSide = 4;            // of the frame that shows how time grows with pixels

double pixels(const RenderSettings& s) { return static_cast<double>(s.width) * s.height; }

std::vector<ReportStage> stages_of(const std::vector<StageTime>& times, double scale) {
    std::vector<ReportStage> out;
    for (const StageTime& time : times) {
        if (std::ranges::count(out, time.name, &ReportStage::name) > 0) continue;
        std::vector<double> ms;
        for (const StageTime& same : times) {
            if (same.name == time.name) ms.push_back(scale * same.ms);
        }
        out.push_back({time.name, statistics(ms)});
    }
    return out;
}

// Relative half width of the notch.
double noise_of(std::vector<double> times) {
    std::ranges::sort(times);
    return ratio_of(notch(times), quantile(times, 0.5));
}

double shading_ms(const ReportSpeed& speed) {
    for (const ReportStage& stage : speed.stages) {
        if (group_of(stage.name) == StageGroup::shading) return stage.ms.median;
    }
    return 0.0;
}

std::string coverage_key(const RenderSettings& s) {
    return fmt::format("{} {} {} {} {} {}", s.width, s.gbuffer, static_cast<int>(s.tails),
                       s.range_budget, s.tree_share, s.lights.radius);
}

// A ray in double takes as long as about ten evaluations.
ErrorSizeLimits affordable(ErrorSizeLimits limits, const RenderSettings& settings) {
    if (settings.shadows != Shadows::off) limits.evaluations /= 10.0;
    return limits;
}

}  // namespace

// A setting's frames before they are summarised.
struct ReportRun::Timing {
    double expected_ms = 0.0;  // of a frame at full size
    bool scaled = false;
    FrameStats stats;  // of the last frame
    std::vector<StageTime> stages;
    std::vector<double> frames;
    std::vector<double> relative;  // to the default's frame before or after
};

ReportRun::ReportRun(const ReportView& view, const RenderSettings& base,
                     const ErrorSizeLimits& limits)
    : view_(view),
      opened_(base.opened ? base.opened : std::make_shared<const Gpu>(choose_device(base.device))),
      error_size_(kilolux::error_size({base.width, base.height},
                                      base.lights.count + view.scene.lights.size(),
                                      affordable(limits, base))),
      references_(view, at_error_size(base)) {}

void ReportRun::on_step(std::function<void()> call) {
    references_.on_step(call);
    on_step_ = std::move(call);
}

RenderSettings ReportRun::at_error_size(RenderSettings settings) const {
    settings.width = error_size_[0];
    settings.height = error_size_[1];
    settings.opened = opened_;
    return settings;
}

// Timed frames stand for frames in which everything moves.
RenderSettings ReportRun::whole_frames(const ReportSetting& setting) const {
    RenderSettings out = setting.settings;
    out.no_reuse = true;
    out.opened = opened_;
    return out;
}

std::vector<ReportRow> ReportRun::measure(const std::vector<ReportSetting>& settings,
                                          const BenchFrames& frames) {
    std::vector<ReportRow> rows;
    std::vector<Timing> timings(settings.size());
    for (std::size_t i = 0; i < settings.size(); ++i) {
        rows.push_back(compare(settings[i], timings[i]));
        on_progress_();
    }
    if (!timings.front().scaled) standard_.emplace(view_.opened, whole_frames(settings.front()));
    for (int round = 0; round < kRounds; ++round) {
        for (std::size_t i = 0; i < settings.size(); ++i) {
            if (i == 0 || time_only_(rows[i])) {
                time_frames(settings[i], frames, timings[i], i > 0 ? &timings.front() : nullptr);
            }
            on_progress_();
        }
    }
    standard_.reset();
    for (std::size_t i = 0; i < settings.size(); ++i) {
        ReportSpeed& speed = rows[i].speed;
        speed = speed_of(rows[i], timings[i]);
        if (timings[i].frames.empty()) {
            speed.relative = std::numeric_limits<double>::infinity();
            continue;
        }
        if (timings[i].relative.empty()) {
            speed.relative = speed.frame_ms / rows.front().speed.frame_ms;
            speed.relative_p5 = speed.relative_p95 = speed.relative;
        }
        speed.frame_ms = speed.relative * rows.front().speed.frame_ms;
        count(rows[i], timings[i]);
    }
    mark_fronts(rows);
    return rows;
}

// The picture whose error is measured. Of several samples with random ranges it is their mean
// without jitter, whose edges no reference has. A first frame that seems slow is made again: it may
// have built the kernels.
Frame ReportRun::picture_of(Renderer& renderer, const ReportSetting& setting) {
    Frame frame = renderer.render(view_.camera, view_.time);
    const double whole = pixels(setting.settings) / pixels(renderer.settings());
    if (frame.stats.frame_ms * whole > kSlowFrameMs) {
        on_step_();
        frame = renderer.render(view_.camera, view_.time);
    }
    const int samples = renderer.settings().samples;
    if (setting.axis != SettingAxis::cut_off || samples <= 1) return frame;
    std::vector<double> sums(frame.radiance.size());
    RenderSettings one = renderer.settings();
    one.samples = 1;
    for (int i = 0; i < samples; ++i) {
        on_step_();
        if (i > 0) ++one.seed;
        renderer.change(one);
        const std::vector<float> light = renderer.render(view_.camera, view_.time).radiance;
        for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += light[k];
    }
    for (std::size_t k = 0; k < sums.size(); ++k) {
        frame.radiance[k] = static_cast<float>(sums[k] / samples);
    }
    frame.display = display_codes(rgb_image_of(frame.width, frame.height, frame.radiance),
                                  one.exposure, one.tone_curve);
    return frame;
}

ReportRow ReportRun::compare(const ReportSetting& setting, Timing& timing) {
    on_step_();
    const RenderSettings settings = at_error_size(setting.settings);
    ReportRow row;
    row.setting = setting;
    row.cut_off = cut_off_of(view_.scene, settings);
    const ComparedReference& kernels = references_.kernels(settings);
    Renderer renderer(view_.opened, settings);
    const Frame frame = picture_of(renderer, setting);
    if (settings.renderer == RendererKind::deferred) {
        row.missed_lights = missed_lights(renderer.lit_surfaces().surfaces, kernels.picture);
    }
    row.kernels = picture_errors(frame, kernels);
    row.surfaces = picture_errors(frame, references_.surfaces(settings));
    row.unbounded = picture_errors(frame, references_.unbounded());
    row.picture = rgb_image_of(frame.width, frame.height, frame.radiance);
    row.display = frame.display;
    const ReferencePicture& drawn = references_.drawn(settings).picture;
    row.drawn = compare_hdr(row.picture, drawn.radiance, {.scale = &drawn.scale});
    if (std::ranges::any_of(view_.scene.lights, lacks_range)) {
        row.tails = compare_hdr(row.picture, references_.unlimited(settings).picture.radiance);
    }
    row.estimate = estimated_error(row, renderer);
    timing.stats = frame.stats;
    timing.expected_ms = expected_ms(setting.settings, frame.stats.frame_ms);
    timing.scaled = timing.expected_ms > kSlowFrameMs;
    if (timing.scaled) {
        timing.frames = {frame.stats.frame_ms};
        timing.stages = frame.stats.stages;
    }
    return row;
}

// Time of a frame at full size, extrapolated from that of the comparison. Where a small frame's
// time does not grow with its pixels (few pixels leave a GPU idle), a larger frame is timed.
double ReportRun::expected_ms(const RenderSettings& whole, double compared_ms) {
    RenderSettings larger = at_error_size(whole);
    const TimedFrame small{pixels(larger), compared_ms};
    const double proportional = compared_ms * pixels(whole) / small.pixels;
    larger.width *= kLargerSide;
    larger.height *= kLargerSide;
    if (proportional <= kSlowFrameMs || pixels(larger) >= pixels(whole)) return proportional;
    Renderer renderer(view_.opened, larger);
    on_step_();
    renderer.render(view_.camera, view_.time);  // makes what later frames reuse
    on_step_();
    const Frame frame = renderer.render(view_.camera, view_.time);
    return extrapolated_ms(small, {pixels(larger), frame.stats.frame_ms}, pixels(whole));
}

// Measured on a further frame, since estimating the error takes time.
std::optional<ErrorEstimate> ReportRun::estimated_error(const ReportRow& row, Renderer& renderer) {
    RenderSettings settings = at_error_size(row.setting.settings);
    const std::optional<EstimateKind> kind = estimate_kind(view_.scene, settings);
    if (!kind) return std::nullopt;
    const ReferencePicture& reference = references_.unlimited(settings).picture;
    on_step_();
    settings.samples = 1;
    settings.want = {};
    settings.want.display = false;
    settings.want.aovs = {estimate_aov(*kind)};
    renderer.change(settings);
    const Frame frame = renderer.render(view_.camera, view_.time);
    return compare_estimate(*kind, frame.aovs.front(), row.setting.settings.samples, row.picture,
                            reference.radiance);
}

void ReportRun::render_into(Renderer& renderer, Timing& timing) {
    on_step_();
    const Frame frame = renderer.render(view_.camera, view_.time);
    timing.stats = frame.stats;
    timing.frames.push_back(frame.stats.frame_ms);
    timing.stages.insert(timing.stages.end(), frame.stats.stages.begin(), frame.stats.stages.end());
}

// Times a round's frames of a setting, each paired with one of the default's, which is rendered
// first in every other pair.
void ReportRun::time_frames(const ReportSetting& setting, const BenchFrames& frames, Timing& timing,
                            Timing* standard) {
    if (timing.scaled) return;
    const int affordable = static_cast<int>(kSettingMs / std::max(timing.expected_ms, 1e-3));
    const int measured =
        std::clamp((frames.measured + kRounds - 1) / kRounds, 1, std::max(1, affordable));
    std::optional<Renderer> own;
    if (standard || !standard_) own.emplace(view_.opened, whole_frames(setting));
    Renderer& renderer = own ? *own : *standard_;
    for (int i = 0; i < std::min(frames.warm_up, affordable); ++i) {
        on_step_();
        renderer.render(view_.camera, view_.time);
    }
    for (int i = 0; i < measured; ++i) {
        const bool paired = standard && standard_;
        if (paired && i % 2 == 0) render_into(*standard_, *standard);
        render_into(renderer, timing);
        if (paired && i % 2 == 1) render_into(*standard_, *standard);
        if (paired) timing.relative.push_back(timing.frames.back() / standard->frames.back());
    }
    timing.expected_ms = timing.frames.back();
}

ReportSpeed ReportRun::speed_of(const ReportRow& row, const Timing& timing) const {
    const RenderSettings& settings = row.setting.settings;
    ReportSpeed out;
    out.scaled = timing.scaled;
    const double scale = timing.scaled ? pixels(settings) / pixels(at_error_size(settings)) : 1.0;
    out.frame_ms = scale * statistics(timing.frames).median;
    out.frames = timing.frames.size();
    if (!timing.relative.empty()) {
        const Statistics relative = statistics(timing.relative);
        out.relative = relative.median;
        out.relative_p5 = relative.p5;
        out.relative_p95 = relative.p95;
        out.noise = noise_of(timing.relative);
    }
    out.stages = stages_of(timing.stages, scale);
    return out;
}

void ReportRun::count(ReportRow& row, const Timing& timing) {
    on_step_();
    RenderSettings settings = row.setting.settings;
    settings.opened = opened_;
    if (timing.scaled) settings = at_error_size(settings);
    RenderSettings counted = settings;
    counted.want.counts = true;
    counted.renderer = RendererKind::deferred;
    const auto [found, is_new] = coverages_.try_emplace(coverage_key(counted));
    if (is_new) {
        found->second = Renderer(view_.opened, counted).render(view_.camera, view_.time).stats;
    }
    FrameStats stats = timing.stats;
    if (is_forward(settings.renderer)) {
        counted.renderer = settings.renderer;
        stats = Renderer(view_.opened, counted).render(view_.camera, view_.time).stats;
    }
    row.speed.k = stats.evaluations_per_pixel;
    row.speed.useful_k = found->second.useful_evaluations_per_pixel;
    const double scale = timing.scaled ? pixels(row.setting.settings) / pixels(settings) : 1.0;
    const double evaluations =
        scale * row.speed.k * static_cast<double>(found->second.surface_pixels);
    row.speed.evaluations_per_s = ratio_of(1e3 * evaluations, shading_ms(row.speed));
}

double extrapolated_ms(const TimedFrame& small, const TimedFrame& larger, double pixels) {
    const double slope = std::max(0.0, larger.ms - small.ms) / (larger.pixels - small.pixels);
    return larger.ms + slope * (pixels - larger.pixels);
}

std::optional<double> surfaces_rmse(const ReportRow& row) {
    if (!keeps_ranges(row.setting.axis)) return std::nullopt;
    return row.surfaces.hdr.rmse;
}

std::optional<double> unbounded_rmse(const ReportRow& row) {
    if (!compares_cut_offs(row.setting.axis)) return std::nullopt;
    return row.unbounded.hdr.rmse;
}

std::optional<double> tails_rmse(const ReportRow& row) {
    if (!compares_cut_offs(row.setting.axis)) return std::nullopt;
    return row.tails.rmse;
}

std::vector<std::size_t> front_of(const std::vector<ReportRow>& rows, const RowError& error) {
    std::vector<CostAndError> points;
    std::vector<double> noises;
    for (const ReportRow& row : rows) {
        const std::optional<double> e = error(row);
        points.push_back({row.speed.relative, e.value_or(std::nan(""))});
        if (e) noises.push_back(row.speed.noise);
    }
    if (noises.empty()) return {};
    const double noise = statistics(noises).median;
    return pareto_set(points, {std::max(kCostResolution, 2.0 * noise), kErrorResolution});
}

void mark_fronts(std::vector<ReportRow>& rows) {
    for (const std::size_t i : front_of(rows, surfaces_rmse)) rows[i].surfaces_front = true;
    for (const std::size_t i : front_of(rows, unbounded_rmse)) rows[i].unbounded_front = true;
    for (const std::size_t i : front_of(rows, tails_rmse)) rows[i].tails_front = true;
}

const ReportRow* row_that_beats_default(const std::vector<ReportRow>& rows) {
    const std::optional<double> error = rows.empty() ? std::nullopt : surfaces_rmse(rows.front());
    if (!error) return nullptr;
    const std::vector<std::size_t> front = front_of(rows, surfaces_rmse);
    if (std::ranges::count(front, std::size_t{0}) > 0) return nullptr;
    const auto beats = [&](std::size_t i) {
        return *surfaces_rmse(rows[i]) <= (1.0 + kErrorResolution) * *error;
    };
    const auto found = std::ranges::find_if(front, beats);  // ascending by time
    return found == front.end() ? nullptr : &rows[*found];
}

}  // namespace kilolux
