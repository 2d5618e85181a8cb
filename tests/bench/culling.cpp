// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/culling.h"

#include <algorithm>

#include "host/lighting/coarse_light_lists.h"
#include "host/measure/roofline/roofline.h"
#include "host/render/lights/light_order.h"
#include "host/render/lights/light_rows.h"
#include "host/render/plan/grid_request.h"
#include "host/render/plan/kernel_choice.h"

namespace kilolux {
namespace {

constexpr double kLongBruteForceMs = 1000.0;

// Entries of `lists` that `oracle` does not have in the same cluster; both ascend.
std::uint64_t foreign_pairs(const HostCoarseLists& lists, const HostCoarseLists& oracle) {
    std::uint64_t foreign = 0;
    for (std::size_t c = 0; c + 1 < lists.offsets.size(); ++c) {
        auto known = oracle.lists.begin() + oracle.offsets[c];
        const auto known_end = oracle.lists.begin() + oracle.offsets[c + 1];
        for (uint i = lists.offsets[c]; i < lists.offsets[c + 1]; ++i) {
            known = std::lower_bound(known, known_end, lists.lists[i]);
            if (known == known_end || *known != lists.lists[i]) ++foreign;
        }
    }
    return foreign;
}

double sum_of(const std::vector<StageTimer::Time>& times, std::string_view stage) {
    double ms = 0.0;
    for (const StageTimer::Time& time : times) {
        if (time.stage == stage) ms += time.ms;
    }
    return ms;
}

// The inputs of the lists.
struct CullingCase {
    Gpu gpu;
    Tuning tuning;
    KernelFeatures features;
    LightInput lights;
    View view;
    ClusterGrid grid{};
};

// Times the stages that make coarse lists, and brute force on the same lights and boxes.
void time_lists(const CullingCase& in, int runs, CullingMeasurement& out) {
    CoarseLightLists lists(in.gpu, in.tuning, in.features);
    StageTimer timer;
    CoarseLighting coarse = lists.run(in.lights, in.view, in.grid, timer);
    timer.take();
    out.pairs = lists.pairs();
    std::vector<double> prepare_ms, cull_ms;
    for (int i = 0; i < runs; ++i) {
        coarse = lists.enqueue(in.lights, in.view, in.grid, timer);
        const auto times = timer.take();
        prepare_ms.push_back(sum_of(times, kPrepareLightsStage));
        cull_ms.push_back(sum_of(times, kCullLightsStage));
    }
    out.prepare_ms = statistics(prepare_ms);
    out.cull_ms = statistics(cull_ms);
    CullLights oracle(in.gpu, in.tuning, in.features);
    CoarseLighting expected = coarse;
    std::vector<double> oracle_ms;
    do {
        expected.lists = oracle.brute_force(coarse.lights, coarse.boxes, timer);
        oracle_ms.push_back(sum_of(timer.take(), "cull_lights_brute_force"));
    } while (static_cast<int>(oracle_ms.size()) < runs && oracle_ms.back() < kLongBruteForceMs);
    out.brute_force_ms = statistics(oracle_ms);
    out.brute_force_pairs = oracle.pairs();
    out.foreign_pairs = foreign_pairs(lists.download(coarse), lists.download(expected));
}

void set_limits(CullingMeasurement& m, const KernelFeatures& features, const DeviceLimits& limits) {
    StageCounts counts;
    counts.lights = static_cast<double>(m.lights);
    counts.clusters = static_cast<double>(m.clusters);
    counts.coarse_pairs = static_cast<double>(m.pairs);
    counts.kernels = features;
    StageWork work = cull_lights_work(counts);
    m.limit_ms = stage_limit(work, limits).ms;
    m.bytes = work.bytes();
    work.instructions = {};
    work.launches = 0;
    m.bytes_limit_ms = stage_limit(work, limits).ms;
}

}  // namespace

CullingMeasurement measure_culling(const Scene& scene, const RenderSettings& settings,
                                   const Camera& camera, double time, std::uint64_t light_count,
                                   const DeviceLimits& limits, int runs) {
    LightOptions options = settings.lights;
    options.count = light_count;
    const std::vector<SceneLight> generated = generate_lights(options, scene, time);
    std::vector<SceneLight> lights;
    for (const std::uint32_t light : order_by_place(generated)) lights.push_back(generated[light]);
    const LightRows rows = make_light_rows(lights, camera.position);
    const Gpu gpu = open_device(settings);
    CullingCase in{gpu, choose_tuning(describe(gpu.device), settings.kernels).tuning, {}, {}, {}};
    in.features.light_index_bits = light_count <= 65536 ? 16 : 32;
    in.lights.count = static_cast<uint>(rows.local.size());
    in.lights.lights = GrowingArray<Light>(gpu, "lights").reserve(rows.local.size());
    upload<Light>(gpu, in.lights.lights, rows.local);
    in.view = view_of(camera, settings.width, settings.height);
    in.grid = make_cluster_grid(grid_request(settings.grid, camera, bounds(scene), 0.0f),
                                in.view.width, in.view.height);
    CullingMeasurement out;
    out.lights = rows.local.size();
    out.clusters = in.grid.cluster_count;
    in_stage("culling bench", [&] { time_lists(in, runs, out); });
    set_limits(out, in.features, limits);
    return out;
}

Table culling_table(const std::vector<CullingMeasurement>& measurements) {
    using M = CullingMeasurement;
    return make_table<M>(
        {{"lights", &M::lights},
         {"clusters", &M::clusters},
         {"pairs", &M::pairs},
         {"prepare [ms]", [](const M& m) { return m.prepare_ms.median; }},
         {"cull [ms]", [](const M& m) { return m.cull_ms.median; }},
         {"limit [ms]", &M::limit_ms},
         {"ratio", [](const M& m) { return ratio_of(m.limit_ms, m.cull_ms.median); }},
         {"bandwidth limit [ms]", &M::bytes_limit_ms},
         {"GB/s", [](const M& m) { return ratio_of(1e-6 * m.bytes, m.cull_ms.median); }},
         {"brute force [ms]", [](const M& m) { return m.brute_force_ms.median; }},
         {"speed-up",
          [](const M& m) { return ratio_of(m.brute_force_ms.median, m.cull_ms.median); }},
         {"ns/light",
          [](const M& m) { return ratio_of(1e6 * m.cull_ms.median, double(m.lights)); }},
         {"ns/pair", [](const M& m) { return ratio_of(1e6 * m.cull_ms.median, double(m.pairs)); }},
         {"brute force pairs", &M::brute_force_pairs},
         {"not in brute force", &M::foreign_pairs}},
        measurements);
}

}  // namespace kilolux
