// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/commands/bench/bench.h"

namespace kilolux {

/// A scene and its settings for one point: the first value of each axis. `usual_runs`: without
/// --frames.
struct BenchScene {
    BenchScene(BenchOptions& options, int usual_runs);

    Scene scene;
    Camera camera;
    RenderSettings settings;
    int runs;  // after one that warms up
    nlohmann::ordered_json context;
};
void run_tuning(BenchOptions& options);

}  // namespace kilolux
