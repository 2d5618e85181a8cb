// SPDX-License-Identifier: Apache-2.0
#include "present/commands/bench/bench_sweep.h"

#include <fmt/format.h>
#include <algorithm>
#include <functional>
#include <set>
#include <span>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/interrupt.h"
#include "host/base/text.h"
#include "host/measure/bench/plots.h"
#include "host/measure/bench/row.h"
#include "host/measure/roofline/stages.h"
#include "present/cli/progress.h"
#include "present/cli/scene_choice.h"
#include "present/cli/stats_json.h"
#include "present/commands/bench/bench_context.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// The mode's values where the command line gives none.
SweepAxes with_given(SweepAxes axes, const BenchAxes& given) {
    if (given.renderers) axes.renderers = *given.renderers;
    if (given.resolutions) axes.resolutions = *given.resolutions;
    if (given.lights) axes.lights = *given.lights;
    if (given.grids) axes.grids = *given.grids;
    if (given.lanes) axes.lanes = *given.lanes;
    if (given.gbuffers) axes.gbuffers = *given.gbuffers;
    return axes;
}

// Two small sweeps that share a point.
std::vector<SweepAxes> quick_sweeps(const BenchAxes& given) {
    SweepAxes base;
    base.resolutions = {{480, 270}};
    SweepAxes lights = base, grids = base;
    lights.renderers = {RendererKind::deferred, RendererKind::deferred_all};
    lights.lights = {500, 1000, 2000, 5000};
    grids.grids = {{4, 4, 1}, {16, 9, 4}, {30, 17, 16}};
    std::vector<SweepAxes> sweeps = {with_given(lights, given)};
    if (!given.grids) sweeps.push_back(with_given(grids, given));
    return sweeps;
}

// The points of a run and their rows.
struct Sweep {
    std::vector<SweepPoint> points;
    std::vector<BenchRow> rows;
};

// Takes the rows of an earlier run; returns the points that are left to measure.
std::vector<SweepPoint> take_found(Sweep& sweep, const std::optional<BenchLog>& log) {
    std::vector<SweepPoint> left;
    for (const SweepPoint& point : sweep.points) {
        const auto found = log ? log->rows_of(point) : std::vector<BenchRow>{};
        if (found.empty()) left.push_back(point);
        sweep.rows.insert(sweep.rows.end(), found.begin(), found.end());
    }
    if (left.size() < sweep.points.size()) {
        note(fmt::format("{} of {} points were measured before", sweep.points.size() - left.size(),
                         sweep.points.size()));
    }
    return left;
}

// The estimated time of the points' timed frames.
std::string estimate_of(const BenchRun& run, std::span<const SweepPoint> left,
                        const BenchFrames& frames) {
    double ms = 0.0;
    for (const SweepPoint& point : left)
        ms += run.expected_frame_ms(point) * (frames.warm_up + frames.measured);
    return fmt::format("about {} for the frames of {} more points, by a measured frame",
                       duration_text(1e-3 * ms), left.size());
}

// Calls `begin` after old rows are erased and before there are new ones.
void measure_points(const BenchOptions& options, BenchRun& run, Sweep& sweep,
                    std::optional<BenchLog>& log, const std::function<void()>& begin) {
    const BenchFrames frames = bench_frames(options);
    const std::vector<SweepPoint> left = take_found(sweep, log);
    Progress progress("measuring", run.frame_count(left, frames), options.shared.shown_progress());
    run.on_frame([&progress] {
        check_interrupt();
        progress.advance();
    });
    std::set<std::string> explained;
    for (std::size_t i = 0; i < left.size(); ++i) {
        const std::vector<BenchRow> rows = run.measure(left[i], frames);
        if (log) log->append(rows, begin);
        sweep.rows.insert(sweep.rows.end(), rows.begin(), rows.end());
        progress.erase();
        const std::string grid = grid_explanation(left[i], run.grid());
        if (!grid.empty() && explained.insert(grid).second) note(grid);
        if (i == 0 && left.size() > 1) note(estimate_of(run, std::span(left).subspan(1), frames));
    }
    run.on_frame([] {});
}

// Sorts rows by the points, whichever run measured them.
void sort_rows(Sweep& sweep) {
    const auto place = [&sweep](const BenchRow& row) {
        return std::find(sweep.points.begin(), sweep.points.end(), row.point);
    };
    std::stable_sort(sweep.rows.begin(), sweep.rows.end(),
                     [&](const BenchRow& a, const BenchRow& b) { return place(a) < place(b); });
}

// Every stage of a few points; of many, only frames, shading and rows that beat their limit.
std::vector<BenchRow> shown_rows(std::vector<BenchRow> rows, bool every_stage) {
    constexpr std::ptrdiff_t kFewPoints = 4;
    const auto points = std::ranges::count(rows, kFrameStage.name, &BenchRow::stage);
    if (every_stage || points <= kFewPoints) return rows;
    std::erase_if(rows, [](const BenchRow& row) {
        return row.stage != kFrameStage.name && group_of(row.stage) != StageGroup::shading &&
               !row.beats_limit();
    });
    return rows;
}

// A row that beats its limit shows that the limit or the model is wrong.
void require_limits_hold(const std::vector<BenchRow>& rows) {
    for (const BenchRow& row : rows) {
        if (!row.beats_limit()) continue;
        throw ComparisonFailed(fmt::format(
            "{} of {} with {} lights takes {:.4g} ms, less than its limit of {:.4g} ms: measure "
            "the limits again (kilolux info --measure-limits) or report the model as wrong",
            row.stage, renderer_name(row.point.renderer), row.point.lights, row.ms.median,
            row.limit_ms));
    }
}

}  // namespace

void put_sweep(const SweepOutput& output, Json document, const std::vector<BenchRow>& rows) {
    document["rows"] = table_json(bench_table(rows));
    const std::vector<BenchRow> shown = shown_rows(rows, output.every_stage);
    print_result(output.json, document,
                 to_markdown(bench_summary(shown)) + "\n" + bench_legend(shown));
    if (output.folder.empty()) return;
    write_json((output.folder / "bench.json").string(), document);
    const Json& context = document["context"];
    const std::string subtitle =
        fmt::format("{} on {}", context["scene"]["name"].get<std::string>(),
                    context["device"]["name"].get<std::string>());
    if (output.plots) write_plots(bench_plots(rows, subtitle), output.folder);
    note("wrote   " + output.folder.string());
}

std::vector<SweepPoint> bench_points(const BenchOptions& options) {
    std::vector<SweepPoint> points;
    const auto sweeps = options.quick
                            ? quick_sweeps(options.axes)
                            : std::vector<SweepAxes>{with_given(SweepAxes{}, options.axes)};
    for (const SweepAxes& sweep : sweeps) {
        for (const SweepPoint& point : sweep_points(sweep)) {
            if (std::find(points.begin(), points.end(), point) == points.end()) {
                points.push_back(point);
            }
        }
    }
    return points;
}

BenchFrames bench_frames(const BenchOptions& options) {
    const BenchFrames standard = options.quick ? BenchFrames{1, 5} : BenchFrames{};
    return {options.warm_up.value_or(standard.warm_up), options.frames.value_or(standard.measured),
            options.motion};
}

// With --max-error: the setting that is within the budget for the first point, on every axis for
// which the command line gives no values.
BenchOptions with_budget(BenchOptions options, const Scene& scene, const Camera& camera) {
    if (!options.budget.max_error) return options;
    SharedOptions& shared = options.shared;
    shared.settings = settings_at(shared.settings, bench_points(options).front());
    const RenderSettings s =
        settings_within_budget(shared, options.budget, {scene, camera, shared.time});
    shared.settings = s;
    BenchAxes& axes = options.axes;
    if (!axes.renderers) axes.renderers = {s.renderer};
    if (!axes.grids) axes.grids = {{s.grid.tiles_x, s.grid.tiles_y, s.grid.slices_per_octave}};
    if (!axes.lanes) axes.lanes = {s.kernels.lanes};
    if (!axes.gbuffers) axes.gbuffers = {s.gbuffer};
    return options;
}

// Describes the lights: for a sweep the first number, and that others follow.
Scene open_swept_scene(BenchOptions& options) {
    std::vector<std::string> counts;
    for (const SweepPoint& point : bench_points(options)) {
        const std::string count = fmt::to_string(point.lights);
        if (std::ranges::find(counts, count) == counts.end()) counts.push_back(count);
    }
    options.shared.settings.lights.count = bench_points(options).front().lights;
    Scene scene = open_scene(options.shared);
    if (counts.size() > 1) note("sweep   generated lights: " + joined(counts));
    return scene;
}

void run_sweep(BenchOptions& asked) {
    const Scene scene = open_swept_scene(asked);
    const Camera camera = choose_camera(asked.shared, scene);
    const BenchOptions options = with_budget(asked, scene, camera);
    Sweep sweep;
    const std::vector<SweepPoint> points = bench_points(options);
    sweep.points = items_of_shard(points, options.shard);
    const DeviceInfo device = describe(choose_device(options.shared.settings.device));
    std::vector<std::string> names;
    std::ranges::transform(points, std::back_inserter(names), point_text);
    Json document =
        result_document(bench_context(options.shared, bench_frames(options), scene, camera, device),
                        names, options.shard);
    std::optional<BenchLog> log;
    const SweepOutput output{options.output, options.json, !options.output.empty() && can_plot(),
                             options.shared.verbose};
    if (!options.output.empty()) {
        const fs::path csv = options.output / "bench.csv";
        log.emplace(csv, options.resume);
        if (!log->rows().empty()) require_same_context(context_file(csv), document);
    }
    const auto write_context = [&] {
        write_json(context_file(options.output / "bench.csv").string(), document);
    };
    BenchRun run(scene, options.shared.settings, camera, options.shared.time);
    measure_points(options, run, sweep, log, write_context);
    sort_rows(sweep);
    document["limits"] = limits_json(run.limits());
    if (log) write_context();
    if (log && sweep.points.empty()) log->append({});  // a shard without points has no rows
    put_sweep(output, document, sweep.rows);
    require_limits_hold(sweep.rows);
}

}  // namespace kilolux
