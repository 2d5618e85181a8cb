// SPDX-License-Identifier: Apache-2.0
// Times single kernels beside the device's limits and other implementations, and fails where the
// results differ:
//   kernel_bench culling     light lists for 1000 to a million lights, against brute force
//   kernel_bench shading     the shading kernel alone, by model and lanes
//   kernel_bench visibility  shadow rays: a walk for all pixels of a cluster, and one for each
//   bundle
// Options are those of `kilolux bench`.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/interrupt.h"
#include "host/measure/roofline/limit_watch.h"
#include "present/cli/progress.h"
#include "present/cli/scene_choice.h"
#include "present/commands/bench/bench.h"
#include "present/commands/bench/bench_options.h"
#include "present/commands/bench/bench_tune.h"
#include "present/exit_code.h"
#include "tests/bench/culling.h"
#include "tests/bench/shading.h"
#include "tests/bench/shadow_error.h"
#include "tests/bench/visibility.h"

namespace kilolux {
namespace {

void bench_culling(BenchOptions& options) {
    const BenchScene bench(options, 10);
    const DeviceLimits limits = LimitWatch(choose_device(bench.settings.device)).limits();
    const std::vector<std::uint64_t> standard = {1000, 5000, 10000, 100000, 1000000};
    const std::vector<std::uint64_t> counts = options.axes.lights.value_or(standard);
    std::vector<CullingMeasurement> measured;
    std::uint64_t foreign = 0;
    {
        Progress progress("culling", counts.size(), options.shared.shown_progress());
        for (const std::uint64_t count : counts) {
            check_interrupt();
            measured.push_back(measure_culling(bench.scene, bench.settings, bench.camera,
                                               options.shared.time, count, limits, bench.runs));
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

void bench_shading(BenchOptions& options) {
    const BenchScene bench(options, 5);
    const auto total =
        static_cast<std::size_t>((bench.runs + 1) * shading_variants(bench.settings));
    std::vector<ShadingMeasurement> measured;
    {
        Progress progress("shading", total, options.shared.shown_progress());
        // Measures the limits now: other work on the machine then slows limits and kernels alike.
        const DeviceLimits limits =
            measure_device_limits(Gpu(choose_device(bench.settings.device)));
        measured = measure_shading(bench.settings, limits, bench.runs, [&] {
            check_interrupt();
            progress.advance();
        });
    }
    put_table(options, "shading", shading_table(measured), bench.context);
}

void bench_visibility(BenchOptions& options) {
    Shadows& shadows = options.shared.settings.shadows;
    if (shadows == Shadows::off) shadows = Shadows::exact;
    BenchScene bench(options, 5);
    LightingBench lighting(bench.scene, bench.settings, bench.camera, options.shared.time);
    const DeviceLimits limits = LimitWatch(choose_device(bench.settings.device)).limits();
    std::vector<VisibilityMeasurement> measured;
    {
        Progress progress("visibility", static_cast<std::size_t>(visibility_runs(bench.runs)),
                          options.shared.shown_progress());
        measured = measure_visibility(lighting, limits, bench.runs, [&] {
            check_interrupt();
            progress.advance();
        });
    }
    put_table(options, "visibility", visibility_table(measured), bench.context);
    note("both see the same, bit for bit");
}

void bench_shadows(BenchOptions& options) {
    const BenchScene bench(options, 1024);
    const ReportView view{bench.scene, bench.camera, options.shared.time};
    ShadowErrorPlan plan;
    plan.draws = bench.runs;
    const auto errors = measure_shadow_error(view, bench.settings, plan, check_interrupt);
    put_table(options, "shadows", shadow_error_table(errors), bench.context);
    note(shadow_error_notes());
    if (!options.output.empty() && can_plot())
        write_plot(shadow_error_plot(errors, options.shared.scene),
                   options.output / "shadow_variance_over_rays");
}

constexpr struct {
    const char* name;
    void (*run)(BenchOptions& options);
} kModes[] = {{"culling", bench_culling},
              {"shading", bench_shading},
              {"visibility", bench_visibility},
              {"shadows", bench_shadows}};

void run_kernel_bench(const std::vector<std::string>& words) {
    for (const auto& [name, run] : kModes) {
        if (words.empty() || words.front() != name) continue;
        CLI::App app("kernel_bench");
        BenchOptions options;
        add_bench_options(app, options);
        app.parse(std::vector<std::string>(words.rbegin(), words.rend() - 1));
        begin_command(options.shared);
        measure_swarm(options.shared);
        make_output_folder(options.output);
        return run(options);
    }
    throw UsageError(
        "usage: kernel_bench culling|shading|visibility|shadows [OPTIONS of kilolux bench]");
}

}  // namespace
}  // namespace kilolux

int main(int argc, char** argv) {
    kilolux::catch_signals();
    return kilolux::exit_code_of(
        [&] { kilolux::run_kernel_bench(std::vector<std::string>(argv + 1, argv + argc)); });
}
