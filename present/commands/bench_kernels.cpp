// SPDX-License-Identifier: Apache-2.0
// The bench's modes that time kernels without pictures, and the search for the fastest work sizes.
#include <fmt/format.h>

#include "host/base/error.h"
#include "host/base/interrupt.h"
#include "host/base/log.h"
#include "host/measure/bench/culling.h"
#include "host/measure/bench/shading.h"
#include "host/measure/bench/tune.h"
#include "host/measure/bench/visibility.h"
#include "host/measure/roofline/limit_kernels.h"
#include "present/cli/progress.h"
#include "present/cli/scene_choice.h"
#include "present/commands/bench.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

// The first value of each axis, as these modes do not sweep them.
RenderSettings single_settings(const BenchOptions& options) {
    const std::vector<SweepPoint> points = bench_points(options);
    return settings_at(options.shared.settings, points.front());
}

// What all modes need.
struct Bench {
    explicit Bench(BenchOptions& options)
        : scene(open_scene(options.shared)),
          camera(choose_camera(options.shared, scene)),
          settings(single_settings(options)),
          context(bench_context(options.shared, bench_frames(options), scene, camera,
                                describe(choose_device(settings.device)))) {
        context["resolution"] = {settings.width, settings.height};
    }
    Scene scene;
    Camera camera;
    RenderSettings settings;
    Json context;
};

Cell tuning_cell(const TuningTrial& trial) {
    if (!trial.error.empty()) return "refused: " + trial.error;
    if (!trial.same_picture) return std::string("another picture");
    return std::string(trial.accepted ? "taken" : "");
}

Table tuning_table(const TuningResult& result) {
    Table table;
    table.columns = {"parameter", "value", "ms", "start / ms", "result"};
    table.rows.push_back({std::string("start"), Cell(), result.start_ms, 1.0, std::string()});
    for (const TuningTrial& trial : result.trials) {
        const bool ran = trial.error.empty() && trial.ms > 0.0;
        table.rows.push_back({trial.parameter, std::int64_t{trial.value},
                              ran ? Cell(trial.ms) : Cell(),
                              ran ? Cell(result.start_ms / trial.ms) : Cell(), tuning_cell(trial)});
    }
    return table;
}

}  // namespace

void run_culling(BenchOptions& options) {
    const Bench bench(options);
    const DeviceLimits limits = LimitWatch(choose_device(bench.settings.device)).limits();
    const std::vector<std::uint64_t> standard = {1000, 5000, 10000, 100000, 1000000};
    const std::vector<std::uint64_t> counts = options.axes.lights.value_or(standard);
    std::vector<CullingMeasurement> measured;
    std::uint64_t foreign = 0;
    {
        Progress progress("culling", counts.size(), !options.shared.quiet);
        for (const std::uint64_t count : counts) {
            check_interrupt();
            measured.push_back(measure_culling(bench.scene, bench.settings, bench.camera,
                                               options.shared.time, count, limits,
                                               options.frames.value_or(10)));
            foreign += measured.back().foreign_pairs;
            progress.advance();
        }
    }
    put_table(options, "culling", culling_table(measured), bench.context);
    if (foreign > 0) {
        throw Error(
            fmt::format("culling: {} entries of the lists are not in brute force's", foreign));
    }
    for (const CullingMeasurement& m : measured) {
        if (m.pairs != m.brute_force_pairs) {
            throw Error(fmt::format("culling: {} pairs, but brute force finds {}", m.pairs,
                                    m.brute_force_pairs));
        }
    }
    note("the lists equal brute force's, entry by entry");
}

void run_shading(BenchOptions& options) {
    const Bench bench(options);
    const int runs = options.frames.value_or(5);
    const auto total = static_cast<std::size_t>((runs + 1) * shading_variants(bench.settings));
    std::vector<ShadingMeasurement> measured;
    {
        Progress progress("shading", total, !options.shared.quiet);
        // Measures the limits now: other work on the machine then slows limits and kernels alike.
        const DeviceLimits limits =
            measure_device_limits(Gpu(choose_device(bench.settings.device)));
        measured = measure_shading(bench.settings, limits, runs, [&] {
            check_interrupt();
            progress.advance();
        });
    }
    put_table(options, "shading", shading_table(measured), bench.context);
}

void run_visibility(BenchOptions& options) {
    Bench bench(options);
    LightingBench lighting(bench.scene, bench.settings, bench.camera, options.shared.time);
    const int runs = options.frames.value_or(5);
    bench.context["frames"]["measured"] = runs;
    bench.context["frames"]["warm_up"] = 1;
    const DeviceLimits limits = LimitWatch(choose_device(bench.settings.device)).limits();
    std::vector<VisibilityMeasurement> measured;
    {
        Progress progress("visibility", static_cast<std::size_t>(visibility_runs(runs)),
                          !options.shared.quiet);
        measured = measure_visibility(lighting, limits, runs, [&] {
            check_interrupt();
            progress.advance();
        });
    }
    put_table(options, "visibility", visibility_table(measured), bench.context);
    note("both see the same, bit for bit");
}

void run_tuning(BenchOptions& options) {
    const Bench bench(options);
    LightingBench lighting(bench.scene, bench.settings, bench.camera, options.shared.time);
    const int runs = options.frames.value_or(5);
    const auto on_trial = [](const StoredTuning& tuning, double ms) {
        check_interrupt();
        detail(fmt::format("{:.4g} ms: {}", ms, tuning_text(tuning_json(tuning))));
    };
    TuningResult result = tune(lighting, runs, on_trial);
    note(fmt::format("kernels   {:.4g} ms, built-in {:.4g} ms", result.best_ms, result.start_ms));
    if (!has_blended_surfaces(bench.scene)) {
        GeometryTuning geometry = tune_geometry(lighting, result.best, runs, on_trial);
        note(fmt::format("geometry  {}: frames of {:.4g} ms with compute, {:.4g} ms with ids",
                         geometry.raster.best.tuning.geometry == 1 ? "compute" : "ids",
                         geometry.raster.best_ms, geometry.ids_ms));
        result.best = geometry.raster.best;
        std::ranges::move(geometry.raster.trials, std::back_inserter(result.trials));
    }
    put_table(options, "tuning", tuning_table(result), bench.context);
    store_tuning(lighting.device(), result.best);
    note("kept      " + tuning_text(tuning_json(result.best)));
}

}  // namespace kilolux
