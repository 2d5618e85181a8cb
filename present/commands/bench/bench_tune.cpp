// SPDX-License-Identifier: Apache-2.0
// The search for the fastest work sizes.
#include "present/commands/bench/bench_tune.h"

#include <fmt/format.h>

#include "host/base/log.h"
#include "host/base/system/interrupt.h"
#include "host/measure/bench/tune.h"
#include "present/cli/scene_choice.h"
#include "present/commands/bench/bench_context.h"
#include "present/commands/bench/bench_sweep.h"

namespace kilolux {
namespace {

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

BenchScene::BenchScene(BenchOptions& options, int usual_runs)
    : scene(open_scene(options.shared)),
      camera(choose_camera(options.shared, scene)),
      settings(settings_at(options.shared.settings, bench_points(options).front())),
      runs(options.frames.value_or(usual_runs)),
      context(bench_context(options.shared, {.warm_up = 1, .measured = runs}, scene, camera,
                            describe(choose_device(settings.device)))) {
    context["resolution"] = {settings.width, settings.height};
}

void run_tuning(BenchOptions& options) {
    const BenchScene bench(options, 5);
    LightingBench lighting(bench.scene, bench.settings, bench.camera, options.shared.time);
    const auto on_trial = [](const StoredTuning& tuning, double ms) {
        check_interrupt();
        detail(fmt::format("{:.4g} ms: {}", ms, tuning_text(tuning_json(tuning))));
    };
    TuningResult result = tune(lighting, bench.runs, on_trial);
    note(fmt::format("kernels   {:.4g} ms, built-in {:.4g} ms", result.best_ms, result.start_ms));
    if (!has_blended_surfaces(bench.scene)) {
        GeometryTuning geometry = tune_geometry(lighting, result.best, bench.runs, on_trial);
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
