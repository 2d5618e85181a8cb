// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/visibility.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <limits>

#include "host/base/error.h"
#include "host/measure/metrics/statistics.h"
#include "host/stages/shadows/cast_shadows.h"

namespace kilolux {
namespace {

double stage_ms(const FrameStats& stats) {
    const auto found = std::ranges::find(stats.stages, kCastShadowsStage.name, &StageTime::name);
    return found == stats.stages.end() ? 0.0 : found->ms;
}

// The request with a walk for each vector of pixels.
LightingRequest bundled(LightingRequest request) {
    request.tuning.tuning.shadow_group = 0;
    return request;
}

void set_report(VisibilityMeasurement& out, const LightingRun& run, const LightingRequest& request,
                const LightingBench& bench, const DeviceLimits& limits) {
    const FrameSetup setup = frame_setup(bench.settings(), request.plan, bench.device());
    for (const StageReport& report : stage_reports(run.stats, limits, setup)) {
        if (report.stage == kCastShadowsStage.name) static_cast<StageEffort&>(out) = report;
    }
    out.counts = run.stats.shadows;
}

}  // namespace

std::vector<VisibilityMeasurement> measure_visibility(LightingBench& bench,
                                                      const DeviceLimits& limits, int runs,
                                                      const std::function<void()>& on_run) {
    LightingRequest request = bench.request();
    if (!request.plan.kernels.shadows)
        throw Error("visibility: nothing in the scene casts shadows");
    request.runs = 1;
    const std::array requests = {request, bundled(request)};
    std::vector<VisibilityMeasurement> out(2);
    out[0].walks = "shafts";
    out[1].walks = fmt::format("bundles of {} rays", request.tuning.lanes);
    for (VisibilityMeasurement& m : out) m.ms = std::numeric_limits<double>::infinity();
    std::uint64_t picture = 0;
    for (int i = 0; i < runs; ++i) {
        for (const std::size_t way : {std::size_t{0}, std::size_t{1}}) {
            LightingRequest asked = requests[way];
            asked.counts = i == 0;
            const LightingRun run = bench.run(asked);
            if (i == 0) set_report(out[way], run, asked, bench, limits);
            if (i == 0 && way == 0) picture = run.picture;
            if (run.picture != picture) throw Error("visibility: bundles see other lights");
            out[way].ms = std::min(out[way].ms, stage_ms(run.stats));
            on_run();
        }
    }
    out[1].times = ratio_of(out[1].ms, out[0].ms);
    return out;
}

Table visibility_table(const std::vector<VisibilityMeasurement>& measurements) {
    using M = VisibilityMeasurement;
    const auto each_ray = [](std::uint64_t ShadowCounts::*count) {
        return [count](const M& m) {
            return ratio_of(static_cast<double>(m.counts.*count),
                            static_cast<double>(m.counts.rays));
        };
    };
    return make_table<M>(
        {{"walks", &M::walks},
         {"least [ms]", &M::ms},
         {"times shafts", &M::times},
         {"limit [ms]", &M::limit_ms},
         {"ratio", [](const M& m) { return ratio_of(m.limit_ms, m.ms); }},
         {"bound", &M::bound},
         {"rays", [](const M& m) { return m.counts.rays; }},
         {"rays saved", &M::saved_rays},
         {"rays without a test", [](const M& m) { return m.counts.rays - m.counts.met_rays; }},
         {"number of walks", [](const M& m) { return m.counts.shafts; }},
         {"nodes a ray", each_ray(&ShadowCounts::nodes)},
         {"triangles a ray", each_ray(&ShadowCounts::triangles)},
         {"tests a ray", each_ray(&ShadowCounts::points)},
         {"Grays/s",
          [](const M& m) { return ratio_of(1e-6 * static_cast<double>(m.counts.rays), m.ms); }}},
        measurements);
}

}  // namespace kilolux
