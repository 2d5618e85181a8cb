// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/run.h"

#include <fmt/core.h>
#include <algorithm>
#include <limits>

#include "host/measure/metrics/pareto.h"
#include "host/measure/roofline/stages.h"

namespace kilolux {
namespace {

constexpr double kSettingMs = 10000.0;  // for the frames of a setting in a round

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

// From which relative difference on times differ.
double cost_resolution(double noise) { return std::max(kCostResolution, 2.0 * noise); }

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

}  // namespace

// Timed frames stand for frames in which everything moves.
RenderSettings ReportRun::whole_frames(const ReportSetting& setting) const {
    RenderSettings out = setting.settings;
    out.no_reuse = true;
    out.opened = device().gpu;
    return out;
}

std::vector<ReportRow> ReportRun::measure(const std::vector<ReportSetting>& settings,
                                          const BenchFrames& frames) {
    std::vector<ComparedRow> compared;
    for (const ReportSetting& setting : settings) {
        compared.push_back(compare(setting, device()));
        on_progress_();
    }
    return time(std::move(compared), frames);
}

std::vector<ReportRow> ReportRun::time(std::vector<ComparedRow> compared,
                                       const BenchFrames& frames) {
    coverages_.clear();  // an earlier device may have failed
    time_rounds(compared, frames);
    std::vector<ReportRow> rows;
    for (ComparedRow& each : compared) {
        const ReportTiming& timing = each.timing;
        ReportRow& row = rows.emplace_back(std::move(each.row));
        ReportSpeed& speed = row.speed;
        speed = speed_of(row, timing);
        if (timing.frames.empty()) {
            speed.relative = std::numeric_limits<double>::infinity();
            continue;
        }
        if (timing.relative.empty()) {
            speed.relative = speed.frame_ms / rows.front().speed.frame_ms;
            speed.relative_p5 = speed.relative_p95 = speed.relative;
        }
        speed.frame_ms = speed.relative * rows.front().speed.frame_ms;
        count(row, timing);
    }
    mark_fronts(rows);
    return rows;
}

void ReportRun::time_rounds(std::vector<ComparedRow>& compared, const BenchFrames& frames) {
    ComparedRow& standard = compared.front();
    standard_.reset();
    if (!standard.timing.scaled) {
        standard_.emplace(device().opened, whole_frames(standard.row.setting));
    }
    for (int round = 0; round < kRounds; ++round) {
        for (ComparedRow& each : compared) {
            const bool is_standard = &each == &standard;
            if (is_standard || time_only_(each.row)) {
                time_frames(each.row.setting, frames, each.timing,
                            is_standard ? nullptr : &standard.timing);
            }
            on_progress_();
        }
    }
    standard_.reset();
}

void ReportRun::render_into(Renderer& renderer, ReportTiming& timing) {
    step();
    const Frame frame = renderer.render(view().camera, view().time);
    timing.stats = frame.stats;
    timing.frames.push_back(frame.stats.frame_ms);
    timing.stages.insert(timing.stages.end(), frame.stats.stages.begin(), frame.stats.stages.end());
}

// Times a round's frames of a setting, each paired with one of the default's, which is rendered
// first in every other pair.
void ReportRun::time_frames(const ReportSetting& setting, const BenchFrames& frames,
                            ReportTiming& timing, ReportTiming* standard) {
    if (timing.scaled) return;
    const int affordable = static_cast<int>(kSettingMs / std::max(timing.expected_ms, 1e-3));
    const int measured =
        std::clamp((frames.measured + kRounds - 1) / kRounds, 1, std::max(1, affordable));
    std::optional<Renderer> own;
    if (standard || !standard_) own.emplace(device().opened, whole_frames(setting));
    Renderer& renderer = own ? *own : *standard_;
    for (int i = 0; i < std::min(frames.warm_up, affordable); ++i) {
        step();
        renderer.render(view().camera, view().time);
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

ReportSpeed ReportRun::speed_of(const ReportRow& row, const ReportTiming& timing) const {
    const RenderSettings& settings = row.setting.settings;
    ReportSpeed out;
    out.scaled = timing.scaled;
    const double scale =
        timing.scaled ? pixels_of(settings) / pixels_of(at_error_size(settings)) : 1.0;
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

void ReportRun::count(ReportRow& row, const ReportTiming& timing) {
    step();
    RenderSettings settings = row.setting.settings;
    settings.opened = device().gpu;
    if (timing.scaled) settings = at_error_size(settings);
    RenderSettings counted = settings;
    counted.want.counts = true;
    counted.renderer = RendererKind::deferred;
    const auto [found, is_new] = coverages_.try_emplace(coverage_key(counted));
    if (is_new) {
        found->second = Renderer(device().opened, counted).render(view().camera, view().time).stats;
    }
    FrameStats stats = timing.stats;
    if (is_forward(settings.renderer)) {
        counted.renderer = settings.renderer;
        stats = Renderer(device().opened, counted).render(view().camera, view().time).stats;
    }
    row.speed.k = stats.evaluations_per_pixel;
    row.speed.useful_k = found->second.useful_evaluations_per_pixel;
    const double scale =
        timing.scaled ? pixels_of(row.setting.settings) / pixels_of(settings) : 1.0;
    const double evaluations =
        scale * row.speed.k * static_cast<double>(found->second.surface_pixels);
    row.speed.evaluations_per_s = ratio_of(1e3 * evaluations, shading_ms(row.speed));
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
    return pareto_set(points, {cost_resolution(statistics(noises).median), kErrorResolution});
}

void mark_fronts(std::vector<ReportRow>& rows) {
    for (const std::size_t i : front_of(rows, surfaces_rmse)) rows[i].surfaces_front = true;
    for (const std::size_t i : front_of(rows, unbounded_rmse)) rows[i].unbounded_front = true;
    for (const std::size_t i : front_of(rows, tails_rmse)) rows[i].tails_front = true;
}

const ReportRow* row_that_beats_default(const std::vector<ReportRow>& rows) {
    const std::optional<double> standard =
        rows.empty() ? std::nullopt : surfaces_rmse(rows.front());
    if (!standard) return nullptr;
    const ReportRow* found = nullptr;
    for (const ReportRow& row : rows) {
        const std::optional<double> error = surfaces_rmse(row);
        const bool beats = row.speed.relative < 1.0 - cost_resolution(row.speed.noise) && error &&
                           *error <= (1.0 + kErrorResolution) * *standard;
        if (beats && (!found || row.speed.relative < found->speed.relative)) found = &row;
    }
    return found;
}

}  // namespace kilolux
