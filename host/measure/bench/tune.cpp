// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/tune.h"

#include <algorithm>
#include <limits>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/interrupt.h"
#include "kernels/shared/cluster_grid.h"

namespace kilolux {
namespace {

constexpr int kRounds = 2;

// A parameter and the values that are tried.
struct Dimension {
    const char* name;
    int Tuning::*value;  // null: the lane width
    std::vector<int> values;
};

int value_of(const StoredTuning& tuning, const Dimension& dimension) {
    return dimension.value ? tuning.tuning.*dimension.value : tuning.lanes;
}

StoredTuning with_value(StoredTuning tuning, const Dimension& dimension, int value) {
    (dimension.value ? tuning.tuning.*dimension.value : tuning.lanes) = value;
    return tuning;
}

// CPUs gain from wide lanes and lose with groups, as barriers split their loops; GPUs gain from
// groups.
std::vector<Dimension> dimensions_of(const DeviceInfo& device, bool shadows) {
    const int units = device.compute_units;
    const std::vector<int> rows = {1, 2, 4, 8, 16};
    if (device.is_cpu) {
        return {{"lanes", nullptr, {1, 4, 8, 16}},
                {"shade_rows", &Tuning::shade_rows, rows},
                {"shade_stage", &Tuning::shade_stage, {0, 64}},
                {"shade_prefetch", &Tuning::shade_prefetch, {0, 1}},
                {"cull_chunks",
                 &Tuning::cull_chunks,
                 {units, 2 * units, 4 * units, 8 * units, 16 * units}},
                {"refine_group", &Tuning::refine_group, {1, 4}},
                {"tile_group", &Tuning::tile_group, {1, 4, 16}},
                {"light_group", &Tuning::light_group, {1, 4, 16, 64}}};
    }
    std::vector<Dimension> out = {
        {"lanes", nullptr, {1, 2, 4}},
        {"shade_stage", &Tuning::shade_stage, {0, 32, 64, 128, 256, 512}},
        {"shade_rows", &Tuning::shade_rows, rows},
        {"pbr_lanes", &Tuning::pbr_lanes, {0, 1, 2, 4}},
        {"cull_chunks",
         &Tuning::cull_chunks,
         {units, 4 * units, 8 * units, 16 * units, 32 * units, 64 * units}},
        {"cull_group", &Tuning::cull_group, {32, 64, 128, 256}},
        {"refine_group", &Tuning::refine_group, {16, 32, 64, 128, 256}},
        {"tile_group", &Tuning::tile_group, {16, 32, 64, 128, 256}},
        {"light_group", &Tuning::light_group, {32, 64, 128, 256}},
        {"prefix_group", &Tuning::prefix_group, {64, 128, 256, 512}},
        {"prefix_per_item", &Tuning::prefix_per_item, {4, 8, 16}}};
    // 256 need more local memory than OpenCL promises, where lights have a size.
    if (shadows) out.push_back({"shadow_group", &Tuning::shadow_group, {32, 64, 128}});
    return out;
}

// Dimensions of drawing triangles in OpenCL.
std::vector<Dimension> raster_dimensions_of(const DeviceInfo& device) {
    std::vector<Dimension> out = {
        {"raster_tile_width", &Tuning::raster_tile_width, {16, 32, 64}},
        {"raster_tile_height", &Tuning::raster_tile_height, {16, 32, 64}}};
    if (device.is_cpu) {
        out.push_back({"raster_lanes", &Tuning::raster_lanes, {4, 8, 16}});
    } else {
        out.push_back({"raster_group", &Tuning::raster_group, {64, 128, 256}});
    }
    return out;
}

// A search under way.
struct Search {
    const DeviceInfo& device;
    const MeasureTuning& measure;
    TuningResult result;
    std::uint64_t picture = 0;

    bool was_tried(const StoredTuning& tuning) const {
        return tuning == result.start ||
               std::ranges::count(result.trials, tuning, &TuningTrial::tuning) > 0;
    }

    bool beats(double ms) const { return ms < (1.0 - kTuningGain) * result.best_ms; }

    // Measures both again: other load may have slowed one of them.
    bool confirmed(TuningTrial& trial) {
        result.best_ms = std::min(result.best_ms, measure(result.best).ms);
        trial.ms = std::min(trial.ms, measure(trial.tuning).ms);
        return beats(trial.ms);
    }

    void try_value(const Dimension& dimension, int value) {
        TuningTrial trial{
            dimension.name, value, with_value(result.best, dimension, value), 0.0, true, false, {}};
        if (!is_valid(trial.tuning, device) || was_tried(trial.tuning)) return;
        try {
            const TuningMeasurement measured = measure(trial.tuning);
            trial.ms = measured.ms;
            trial.same_picture = measured.picture == picture;
            trial.accepted = trial.same_picture && beats(trial.ms) && confirmed(trial);
        } catch (const Interrupted&) {
            throw;
        } catch (const Error& error) {
            // The OpenCL compiler also fails after a signal.
            check_interrupt();
            trial.error = error.what();
        }
        if (trial.accepted) {
            result.best = trial.tuning;
            result.best_ms = trial.ms;
        }
        result.trials.push_back(std::move(trial));
    }
};

TuningResult descend(const StoredTuning& start, const DeviceInfo& device,
                     const std::vector<Dimension>& dimensions, const MeasureTuning& measure) {
    const TuningMeasurement first = measure(start);
    Search search{device, measure, {start, start, first.ms, first.ms, {}}, first.picture};
    for (int round = 0; round < kRounds; ++round) {
        const StoredTuning before = search.result.best;
        for (const Dimension& dimension : dimensions) {
            for (const int value : dimension.values) {
                if (value != value_of(search.result.best, dimension))
                    search.try_value(dimension, value);
            }
        }
        if (search.result.best == before) break;
    }
    return std::move(search.result);
}

// Measures the request's frame with other tunings.
MeasureTuning frames_of(LightingBench& bench, LightingRequest request, const OnTrial& on_trial) {
    return [&bench, request, &on_trial](const StoredTuning& tuning) mutable {
        request.tuning = tuning;
        const LightingRun run = bench.run(request);
        if (on_trial) on_trial(tuning, run.ms);
        return TuningMeasurement{run.ms, run.picture};
    };
}

// Time of a frame with OpenGL's ids; infinite where OpenGL cannot draw.
double ids_ms(LightingBench& bench, LightingRequest request) {
    request.drawn_by = Geometry::ids;
    try {
        return bench.run(request).ms;
    } catch (const Interrupted&) {
        throw;
    } catch (const Error& error) {
        check_interrupt();
        detail(error.what());
        return std::numeric_limits<double>::infinity();
    }
}

}  // namespace

TuningResult tune(const StoredTuning& start, const DeviceInfo& device,
                  const MeasureTuning& measure) {
    return descend(start, device, dimensions_of(device, true), measure);
}

TuningResult tune(LightingBench& bench, int runs, const OnTrial& on_trial) {
    LightingRequest request = bench.request();
    request.runs = runs;
    const DeviceInfo& device = bench.device();
    return descend(built_in_tuning(device), device,
                   dimensions_of(device, request.plan.kernels.shadows),
                   frames_of(bench, request, on_trial));
}

GeometryTuning tune_geometry(LightingBench& bench, const StoredTuning& start, int runs,
                             const OnTrial& on_trial) {
    LightingRequest request = bench.request();
    request.runs = runs;
    request.geometry = true;
    request.drawn_by = Geometry::compute;
    const DeviceInfo& device = bench.device();
    GeometryTuning out;
    out.raster =
        descend(start, device, raster_dimensions_of(device), frames_of(bench, request, on_trial));
    request.tuning = out.raster.best;
    out.ids_ms = ids_ms(bench, request);
    out.raster.best.tuning.geometry = out.raster.best_ms < (1.0 - kTuningGain) * out.ids_ms ? 1 : 0;
    return out;
}

}  // namespace kilolux
