// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "host/measure/bench/row.h"
#include "host/measure/bench/run.h"

namespace kilolux {

/// A sweep over numbers of lights that the window asks for.
struct BenchRequest {
    RenderSettings settings;  // width and height: of the measured pictures
    Camera camera;
    double time = 0.0;  // [s]
    std::vector<RendererKind> renderers;
    std::uint64_t most_lights = 16384;
    BenchFrames frames{2, 10};
    std::filesystem::path csv;
};

/// The points of a request: 256, 1024, ... lights up to the most, for each renderer.
std::vector<SweepPoint> points_of(const BenchRequest& request);

/// A running or finished sweep, shared by the thread that measures and the window.
struct BenchProgress {
    std::mutex mutex;  // guards the rows and the text
    std::vector<BenchRow> rows;
    std::string failure;
    std::atomic<std::size_t> frames_done = 0;
    std::atomic<std::size_t> frames_total = 0;
    std::atomic<bool> running = true;
    std::atomic<bool> cancelled = false;
};

/// Measures the request's points in this thread, whose OpenGL context is current; the CSV grows
/// point by point. Ends early once it is cancelled. What fails is told in `progress`.
void run_bench_job(const Scene& scene, const BenchRequest& request, BenchProgress& progress);

/// Frame times against lights, a curve a renderer, both axes logarithmic, in the space there is.
void draw_bench_plot(const std::vector<BenchRow>& rows, float height);

}  // namespace kilolux
