// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "host/gpu/tuning/tuning_store.h"
#include "host/measure/bench/lighting_bench.h"
#include "host/measure/metrics/pareto.h"

namespace kilolux {

/// A frame's time and picture with a tuning.
struct TuningMeasurement {
    double ms = 0.0;
    std::uint64_t picture = 0;  // hash of its bits
};

/// Measures a tuning; throws Error where the device does not accept it.
using MeasureTuning = std::function<TuningMeasurement(const StoredTuning&)>;

/// One alternative that was measured.
struct TuningTrial {
    std::string parameter;  // "lanes", "shade_rows", ...
    int value = 0;
    StoredTuning tuning;  // all values
    double ms = 0.0;
    bool same_picture = true;
    bool accepted = false;
    std::string error;  // why the device refused it; empty: it ran
};

struct TuningResult {
    StoredTuning start, best;
    double start_ms = 0.0;
    double best_ms = 0.0;
    std::vector<TuningTrial> trials;  // in the order of measurement, without the start
};

/// An improvement of less than this share of the time is noise.
inline constexpr double kTuningGain = kCostResolution;

/// Coordinate descent from `start`: two rounds over all parameters, each of which is set to the
/// fastest of its values while the others stay. An alternative is taken if it is faster by more
/// than kTuningGain, also when both are measured again, and its picture has the start's bits.
TuningResult tune(const StoredTuning& start, const DeviceInfo& device,
                  const MeasureTuning& measure);

/// Called after every measurement; it may throw to stop.
using OnTrial = std::function<void(const StoredTuning&, double ms)>;

/// The same on a bench's frame from the built-in table, each time the least of `runs`.
TuningResult tune(LightingBench& bench, int runs, const OnTrial& on_trial = {});

/// The best tuning of triangles drawn in OpenCL, and the time with OpenGL's.
struct GeometryTuning {
    TuningResult raster;  // of frames whose triangles OpenCL draws; best.tuning.geometry says which
                          // of both is faster
    double ids_ms = 0.0;  // the frame with OpenGL's ids; infinite where there is no OpenGL
};

/// Times whole frames, surfaces included, of a scene without surfaces that blend.
GeometryTuning tune_geometry(LightingBench& bench, const StoredTuning& start, int runs,
                             const OnTrial& on_trial = {});

}  // namespace kilolux
