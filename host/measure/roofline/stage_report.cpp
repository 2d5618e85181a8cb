// SPDX-License-Identifier: Apache-2.0
#include "host/measure/roofline/stage_report.h"

namespace kilolux {
namespace {

double evaluations_of(const std::string& stage, const StageCounts& counts) {
    const bool hides = counts.kernels.shadows && !counts.kernels.sampled_shadows;
    if (stage == "shade" && hides) return counts.shadow_seen;
    if (stage == "shade" || stage == "forward" || stage == "forward_plus")
        return counts.full_evaluations + counts.drawn_pixels * counts.directional_lights;
    if (stage == "refine_lights") return counts.refine_tests;
    if (stage == "cast_shadows") return counts.shadow_rays;
    return 0.0;
}

void add_shadows(StageReport& report, const FrameStats& stats, const StageCounts& counts) {
    if (report.stage != "cast_shadows" || stats.shadows.words == 0) return;
    const double pairs = counts.evaluations + counts.drawn_pixels * counts.directional_lights;
    report.shafts = static_cast<double>(stats.shadows.shafts);
    report.saved_rays = pairs - counts.shadow_rays;
}

}  // namespace

std::vector<StageReport> stage_reports(const FrameStats& stats, const DeviceLimits& limits,
                                       const FrameSetup& setup) {
    const StageCounts counts = stage_counts(stats, setup);
    std::vector<StageReport> reports;
    for (const StageTime& stage : stats.stages) {
        StageReport report;
        report.stage = stage.name;
        report.ms = stage.ms;
        if (const auto work = stage_work(stage.name, counts)) {
            const StageLimit limit = stage_limit(*work, limits);
            report.limit_ms = limit.ms;
            report.bound = bound_name(limit.bound);
            report.bytes = work->bytes() + work->bytes_uploaded;
        }
        report.evaluations = evaluations_of(stage.name, counts);
        add_shadows(report, stats, counts);
        reports.push_back(std::move(report));
    }
    return reports;
}

Efficiency efficiency_of(const std::vector<StageReport>& reports, const FrameStats& stats) {
    double ms = 0.0, limit_ms = 0.0;
    for (const StageReport& report : reports) {
        if (report.limit_ms <= 0.0 || report.stage == "gbuffer_bridge") continue;
        ms += report.ms;
        limit_ms += report.limit_ms;
    }
    const double k = stats.evaluations_per_pixel;
    const double useful = stats.useful_evaluations_per_pixel;
    Efficiency efficiency;
    efficiency.hardware = ms > 0.0 ? limit_ms / ms : 0.0;
    efficiency.algorithm = useful < 0.0 ? -1.0 : k > 0.0 ? useful / k : 1.0;
    return efficiency;
}

double other_ms(const FrameStats& stats) {
    double ms = stats.frame_ms;
    for (const StageTime& stage : stats.stages) ms -= stage.ms;
    return ms;
}

}  // namespace kilolux
