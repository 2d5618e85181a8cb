// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/culling.h"

#include <algorithm>
#include <utility>

#include "host/measure/roofline/roofline.h"
#include "host/render/grid_request.h"
#include "host/render/kernel_choice.h"
#include "host/render/light_order.h"
#include "host/render/light_rows.h"
#include "host/stages/build_clusters.h"
#include "host/stages/cull_lights.h"
#include "host/stages/prepare_lights.h"

namespace kilolux {
namespace {

constexpr double kLongBruteForceMs = 1000.0;

// Lists on the host.
template <typename Index>
struct HostLists {
    std::vector<uint> offsets;
    std::vector<Index> lists;
};

template <typename Index>
HostLists<Index> lists_of(const Gpu& gpu, const CoarseLists& lists, std::size_t clusters) {
    HostLists<Index> out;
    out.offsets = download<uint>(gpu, lists.offsets, clusters + 1);
    out.lists = download<Index>(gpu, lists.lists, out.offsets.back());
    return out;
}

// Entries of `lists` that `oracle` does not have in the same cluster; both ascend.
template <typename Index>
std::uint64_t foreign_pairs(const HostLists<Index>& lists, const HostLists<Index>& oracle) {
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

// The stages that make coarse lists, and brute force beside.
class Culling {
 public:
    Culling(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
        : gpu_(gpu),
          features_(features),
          prepare_(gpu, tuning),
          build_(gpu),
          cull_(gpu, tuning, features),
          oracle_(gpu, tuning, features) {}

    void measure(const LightInput& input, const View& view, const ClusterGrid& grid, int runs,
                 CullingMeasurement& out) {
        CoarseLists lists = enqueue(input, view, grid);
        while (!cull_.fits()) lists = enqueue(input, view, grid);
        timer_.take();
        out.pairs = cull_.pairs();
        std::vector<double> prepare_ms, cull_ms;
        for (int i = 0; i < runs; ++i) {
            lists = enqueue(input, view, grid);
            const auto times = timer_.take();
            prepare_ms.push_back(sum_of(times, "prepare_lights"));
            cull_ms.push_back(sum_of(times, "cull_lights"));
        }
        out.prepare_ms = statistics(prepare_ms);
        out.cull_ms = statistics(cull_ms);
        measure_oracle(lists, runs, out);
    }

 private:
    CoarseLists enqueue(const LightInput& input, const View& view, const ClusterGrid& grid) {
        prepared_ = prepare_.enqueue(input, view, grid, timer_);
        boxes_ = build_.enqueue(view, grid, timer_);
        return cull_.enqueue(prepared_, boxes_, timer_);
    }

    void measure_oracle(const CoarseLists& lists, int runs, CullingMeasurement& out) {
        CoarseLists oracle;
        std::vector<double> times_ms;
        do {
            oracle = oracle_.brute_force(prepared_, boxes_, timer_);
            times_ms.push_back(sum_of(timer_.take(), "cull_lights_brute_force"));
        } while (static_cast<int>(times_ms.size()) < runs && times_ms.back() < kLongBruteForceMs);
        out.brute_force_ms = statistics(times_ms);
        out.brute_force_pairs = oracle_.pairs();
        const std::size_t clusters = boxes_.grid.cluster_count;
        const auto compare = [&]<typename Index>() {
            return foreign_pairs(lists_of<Index>(gpu_, lists, clusters),
                                 lists_of<Index>(gpu_, oracle, clusters));
        };
        out.foreign_pairs = features_.light_index_bits == 16
                                ? compare.template operator()<std::uint16_t>()
                                : compare.template operator()<uint>();
    }

    Gpu gpu_;
    KernelFeatures features_;
    PrepareLights prepare_;
    BuildClusters build_;
    CullLights cull_, oracle_;
    StageTimer timer_;
    PreparedLights prepared_;
    ClusterBoxes boxes_;
};

void set_limits(CullingMeasurement& m, const ClusterGrid& grid, const KernelFeatures& features,
                const DeviceLimits& limits) {
    StageCounts counts;
    counts.lights = static_cast<double>(m.lights);
    counts.clusters = grid.cluster_count;
    counts.coarse_pairs = static_cast<double>(m.pairs);
    counts.kernels = features;
    StageWork work = stage_work("cull_lights", counts).value();
    m.limit_ms = stage_limit(work, limits).ms;
    m.bytes = work.bytes_read + work.bytes_written;
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
    std::vector<SceneLight> lights = generate_lights(options, scene, time);
    sort_by_place(lights);
    const LightRows rows = make_light_rows(lights, camera.position);
    const Gpu gpu = open_device(settings);
    LightInput input;
    input.count = static_cast<uint>(rows.local.size());
    input.lights = GrowingBuffer(gpu, "lights").reserve(rows.local.size() * sizeof(Light));
    upload<Light>(gpu, input.lights, rows.local);
    KernelFeatures features;
    features.light_index_bits = light_count <= 65536 ? 16 : 32;
    const ClusterGrid grid =
        make_cluster_grid(grid_request(settings.grid, camera, bounds(scene), 0.0f),
                          static_cast<uint>(settings.width), static_cast<uint>(settings.height));
    CullingMeasurement out;
    out.lights = rows.local.size();
    out.clusters = grid.cluster_count;
    const Tuning tuning = choose_tuning(describe(gpu.device), settings.kernels).tuning;
    in_stage("culling bench", [&] {
        Culling(gpu, tuning, features)
            .measure(input, view_of(camera, settings.width, settings.height), grid, runs, out);
    });
    set_limits(out, grid, features, limits);
    return out;
}

double CullingMeasurement::nanoseconds_per_light() const {
    return lights > 0 ? 1e6 * cull_ms.median / static_cast<double>(lights) : 0.0;
}

double CullingMeasurement::nanoseconds_per_pair() const {
    return pairs > 0 ? 1e6 * cull_ms.median / static_cast<double>(pairs) : 0.0;
}

double CullingMeasurement::speed_up() const {
    return cull_ms.median > 0.0 ? brute_force_ms.median / cull_ms.median : 0.0;
}

Table culling_table(const std::vector<CullingMeasurement>& measurements) {
    Table table;
    table.columns = {"lights",
                     "clusters",
                     "pairs",
                     "prepare [ms]",
                     "cull [ms]",
                     "limit [ms]",
                     "ratio",
                     "bandwidth limit [ms]",
                     "GB/s",
                     "brute force [ms]",
                     "speed-up",
                     "ns/light",
                     "ns/pair",
                     "brute force pairs",
                     "not in brute force"};
    const auto integer = [](std::uint64_t value) { return static_cast<std::int64_t>(value); };
    for (const CullingMeasurement& m : measurements) {
        const double ms = m.cull_ms.median;
        table.rows.push_back({integer(m.lights), integer(m.clusters), integer(m.pairs),
                              m.prepare_ms.median, ms, m.limit_ms, ms > 0.0 ? m.limit_ms / ms : 0.0,
                              m.bytes_limit_ms, ms > 0.0 ? 1e-6 * m.bytes / ms : 0.0,
                              m.brute_force_ms.median, m.speed_up(), m.nanoseconds_per_light(),
                              m.nanoseconds_per_pair(), integer(m.brute_force_pairs),
                              integer(m.foreign_pairs)});
    }
    return table;
}

}  // namespace kilolux
