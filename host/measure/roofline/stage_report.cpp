// SPDX-License-Identifier: Apache-2.0
#include "host/measure/roofline/stage_report.h"

#include "host/measure/roofline/stages.h"
#include "host/stages/shadows/cast_shadows.h"

namespace kilolux {
namespace {

void add_shadows(StageReport& report, const FrameStats& stats, const StageCounts& counts) {
    if (report.stage != kCastShadowsStage.name || stats.shadows.words == 0) return;
    report.shafts = static_cast<double>(stats.shadows.shafts);
    report.saved_rays = counts.listed_pairs() - counts.shadow_rays;
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
        const StageInfo* info = stage_info(stage.name);
        if (info && info->work) {
            const StageWork work = info->work(counts);
            const StageLimit limit = stage_limit(work, limits);
            report.limit_ms = limit.ms;
            report.bound = bound_name(limit.bound);
            report.bytes = work.bytes() + work.bytes_uploaded;
            report.evaluations = work.evaluations;
        }
        add_shadows(report, stats, counts);
        reports.push_back(std::move(report));
    }
    return reports;
}

Efficiency efficiency_of(const std::vector<StageReport>& reports, const FrameStats& stats) {
    double ms = 0.0, limit_ms = 0.0;
    for (const StageReport& report : reports) {
        if (report.limit_ms <= 0.0 || stage_info(report.stage)->opengl_copies) continue;
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

double outside_stages_ms(const FrameStats& stats) {
    double ms = stats.frame_ms;
    for (const StageTime& stage : stats.stages) ms -= stage.ms;
    return ms;
}

}  // namespace kilolux
