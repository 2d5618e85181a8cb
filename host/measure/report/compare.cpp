// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/compare.h"

#include <algorithm>

#include "host/render/plan/scene_plan.h"

namespace kilolux {
namespace {

constexpr double kSlowFrameMs = 20000.0;  // slower frames are not timed at full size
constexpr int kLargerSide = 4;            // of the frame that shows how time grows with pixels

// A ray in double takes as long as about ten evaluations, a light with a size as thirty of them and
// as many rays.
ErrorSizeLimits affordable(ErrorSizeLimits limits, const Scene& scene,
                           const RenderSettings& settings) {
    if (make_scene_plan(scene, settings, 0).kernels.area_lights) limits.evaluations /= 30.0;
    if (settings.shadows != Shadows::off) limits.evaluations /= 10.0;
    return limits;
}

// Settings whose pictures differ by their noise alone.
bool differ_in_rays(const ReportSetting& setting) {
    const bool is_axis = setting.axis == SettingAxis::shadows || setting.axis == SettingAxis::none;
    return is_axis && setting.settings.shadows == Shadows::sampled && setting.settings.samples == 1;
}

}  // namespace

double pixels_of(const RenderSettings& settings) {
    return static_cast<double>(settings.width) * settings.height;
}

ReportComparison::ReportComparison(const ReportView& view, const RenderSettings& base,
                                   const ErrorSizeLimits& limits)
    : view_(view),
      device_{base.opened ? base.opened : std::make_shared<const Gpu>(choose_device(base.device)),
              view.opened},
      error_size_(kilolux::error_size({base.width, base.height},
                                      base.lights.count + view.scene.lights.size(),
                                      affordable(limits, view.scene, base))),
      references_(view, at_error_size(base)) {}

void ReportComparison::on_step(std::function<void()> call) {
    references_.on_step(call);
    on_step_ = std::move(call);
}

RenderSettings ReportComparison::at_error_size(RenderSettings settings) const {
    settings.width = error_size_[0];
    settings.height = error_size_[1];
    settings.opened = device_.gpu;
    return settings;
}

RenderSettings ReportComparison::at_error_size(const ReportRow& row) const {
    RenderSettings out = at_error_size(row.setting.settings);
    out.opened = row.gpu;
    return out;
}

// The picture whose error is measured. Of several samples with random ranges it is their mean
// without jitter, whose edges no reference has. A first frame that seems slow is made again: it may
// have built the kernels.
Frame ReportComparison::picture_of(Renderer& renderer, const ReportSetting& setting) {
    Frame frame = renderer.render(view_.camera, view_.time);
    const double whole = pixels_of(setting.settings) / pixels_of(renderer.settings());
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

ComparedRow ReportComparison::compare(const ReportSetting& setting, const ReportDevice& device) {
    on_step_();
    ComparedRow out;
    ReportRow& row = out.row;
    row.setting = setting;
    row.gpu = device.gpu;
    const RenderSettings settings = at_error_size(row);
    row.cut_off = cut_off_of(view_.scene, settings);
    const ComparedReference& kernels = references_.kernels(settings, device);
    Renderer renderer(device.opened, settings);
    const Frame frame = picture_of(renderer, setting);
    const bool is_listed = settings.renderer == RendererKind::deferred;
    if (is_listed && !has_blended_surfaces(view_.scene)) {
        row.missed_lights = missed_lights(renderer.lit_surfaces().surfaces, kernels.picture);
    }
    row.kernels = picture_errors(frame, kernels);
    row.surfaces = picture_errors(frame, references_.surfaces(settings));
    row.unbounded = picture_errors(frame, references_.unbounded());
    row.picture = rgb_image_of(frame.width, frame.height, frame.radiance);
    row.display = frame.display;
    const ReferencePicture& rasterised = references_.rasterised(settings, device).picture;
    row.rasterised = compare_hdr(row.picture, rasterised.radiance, {.scale = &rasterised.scale});
    if (std::ranges::any_of(view_.scene.lights, lacks_range)) {
        row.tails =
            compare_hdr(row.picture, references_.unlimited(settings, device).picture.radiance);
    }
    row.estimate = estimated_error(row, renderer, device);
    out.timing = timing_of(setting, frame.stats, device);
    return out;
}

// `compared`: of a frame of the comparison, which stands for the frames of a slow setting.
ReportTiming ReportComparison::timing_of(const ReportSetting& setting, const FrameStats& compared,
                                         const ReportDevice& device) {
    ReportTiming out;
    out.stats = compared;
    out.expected_ms = expected_ms(setting.settings, compared.frame_ms, device);
    out.scaled = out.expected_ms > kSlowFrameMs;
    if (out.scaled) {
        out.frames = {compared.frame_ms};
        out.stages = compared.stages;
    }
    return out;
}

void ReportComparison::estimate_again(ComparedRow& compared) {
    if (!compared.timing.scaled) return;
    const ReportSetting& setting = compared.row.setting;
    Renderer renderer(device_.opened, at_error_size(setting.settings));
    on_step_();
    renderer.render(view_.camera, view_.time);  // makes what later frames reuse
    on_step_();
    compared.timing = timing_of(setting, renderer.render(view_.camera, view_.time).stats, device_);
}

// Time of a frame at full size, extrapolated from that of the comparison. Where a small frame's
// time does not grow with its pixels (few pixels leave a GPU idle), a larger frame is timed.
double ReportComparison::expected_ms(const RenderSettings& whole, double compared_ms,
                                     const ReportDevice& device) {
    RenderSettings larger = at_error_size(whole);
    larger.opened = device.gpu;
    const TimedFrame small{pixels_of(larger), compared_ms};
    const double proportional = compared_ms * pixels_of(whole) / small.pixels;
    larger.width *= kLargerSide;
    larger.height *= kLargerSide;
    if (proportional <= kSlowFrameMs || pixels_of(larger) >= pixels_of(whole)) return proportional;
    Renderer renderer(device.opened, larger);
    on_step_();
    renderer.render(view_.camera, view_.time);  // makes what later frames reuse
    on_step_();
    const Frame frame = renderer.render(view_.camera, view_.time);
    return extrapolated_ms(small, {pixels_of(larger), frame.stats.frame_ms}, pixels_of(whole));
}

// Measured on a further frame, since estimating the error takes time.
std::optional<ErrorEstimate> ReportComparison::estimated_error(const ReportRow& row,
                                                               Renderer& renderer,
                                                               const ReportDevice& device) {
    RenderSettings settings = at_error_size(row);
    const std::optional<EstimateKind> kind = estimate_kind(view_.scene, settings);
    if (!kind) return std::nullopt;
    const ReferencePicture& reference = references_.unlimited(settings, device).picture;
    on_step_();
    settings.samples = 1;
    settings.want = {};
    settings.want.display = false;
    settings.want.aovs = {estimate_aov(*kind)};
    renderer.change(settings);
    const Frame frame = renderer.render(view_.camera, view_.time);
    const Layer& estimate = frame.aovs.front();
    ErrorEstimate out = compare_estimate(*kind, estimate, row.setting.settings.samples, row.picture,
                                         reference.radiance);
    if (differ_in_rays(row.setting))
        out.within = share_within(estimate, row.picture, references_.mean(device));
    return out;
}

double extrapolated_ms(const TimedFrame& small, const TimedFrame& larger, double pixels) {
    const double slope = std::max(0.0, larger.ms - small.ms) / (larger.pixels - small.pixels);
    return larger.ms + slope * (pixels - larger.pixels);
}

}  // namespace kilolux
