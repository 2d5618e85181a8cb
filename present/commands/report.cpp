// SPDX-License-Identifier: Apache-2.0
#include "present/commands/report.h"

#include <fmt/core.h>
#include <algorithm>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/atomic_write.h"
#include "host/base/system/interrupt.h"
#include "host/images/images.h"
#include "host/measure/bench/plot.h"
#include "host/measure/report/error_sheets.h"
#include "host/measure/report/run.h"
#include "host/measure/report/tables.h"
#include "present/cli/option_builder.h"
#include "present/cli/progress.h"
#include "present/cli/scene_choice.h"
#include "present/cli/sequence.h"
#include "present/cli/stats_json.h"
#include "present/commands/bench/bench.h"
#include "present/commands/bench/bench_context.h"
#include "present/commands/devices/device_choice.h"
#include "present/commands/devices/report_devices.h"
#include "present/commands/error_budget_options.h"
#include "present/image/image_file.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Report {
    nlohmann::ordered_json context;
    std::vector<std::string> points;  // names of all settings, also of other shards
    std::string caption;              // see report_caption()
    std::vector<ReportRow> rows;
    std::vector<DeviceShare> shares;  // of several devices
    bool plots = false;               // are written
};

BenchFrames report_frames(const ReportOptions& options) {
    return {options.warm_up.value_or(options.quick ? 1 : 2),
            options.frames.value_or(options.quick ? 6 : 20)};
}

std::vector<ReportSetting> chosen_settings(const ReportOptions& options, const Scene& scene) {
    const RenderSettings& asked = options.shared.settings;
    SettingChoice choice = budget_candidates(budget_of(options.shared, options.budget));
    choice.quick = options.quick;
    auto settings = report_settings(scene, asked, describe(choose_device(asked.device)), choice);
    if (options.axes.empty()) return settings;
    std::erase_if(settings, [&](const ReportSetting& setting) {
        return setting.axis != SettingAxis::none &&
               std::ranges::find(options.axes, axis_name(setting.axis)) == options.axes.end();
    });
    return settings;
}

// The settings of the shard. Each shard has the default, with whose frames the others' are paired.
std::vector<ReportSetting> part_of_settings(const std::vector<ReportSetting>& all,
                                            const Shard& shard) {
    std::vector<ReportSetting> out = items_of_shard(all, shard);
    if (shard.index > 0) out.insert(out.begin(), all.front());
    return out;
}

void measure(const ReportOptions& options, const ReportView& view, ReportRun& run, Report& report) {
    const std::vector<ReportSetting> all = chosen_settings(options, view.scene);
    std::ranges::transform(all, std::back_inserter(report.points), &ReportSetting::name);
    const std::vector<ReportSetting> settings = part_of_settings(all, options.shard);
    Progress progress("measuring", ReportRun::steps(settings.size()),
                      options.shared.shown_progress());
    const auto advance = [&progress] { progress.advance(); };
    run.on_step(check_interrupt);
    run.on_progress(advance);
    const BenchFrames frames = report_frames(options);
    if (options.devices.empty()) {
        report.rows = run.measure(settings, frames);
    } else {
        auto [rows, shares] = measure_on(options.devices, run, {view, settings, frames, advance});
        report.rows = std::move(rows);
        report.shares = std::move(shares);
        report.context["devices"] = devices_json(report.shares);
    }
    run.on_step([] {});
    run.on_progress([] {});
}

void write_canvas(const fs::path& file, Canvas canvas) {
    Frame frame;
    frame.width = canvas.width;
    frame.height = canvas.height;
    frame.display = std::move(canvas.rgba);
    write_image(file, frame);
}

void write_errors(const fs::path& folder, const Report& report, const ReportRow& row,
                  ReportRun& run) {
    const auto references = run.references().all(run.at_error_size(row));
    write_canvas(error_map_file(folder, row.setting.name),
                 error_map_sheet(row, references, report.caption));
}

// The summary with its notes: report.md.
std::string report_text(const Report& report) {
    return to_markdown(report_summary(report.rows), 3) + "\n" + report_notes(report.rows) +
           device_lines(report.shares);
}

// The document of --json and report.json.
Json report_json(const Report& report, const Shard& shard) {
    Json out = result_document(report.context, report.points, shard);
    out["rows"] = table_json(report_table(report.rows));
    return out;
}

// Writes cut_offs.csv, and cut_offs.png: the treatments of lights that lack a range, side by side.
void write_cut_offs(const fs::path& folder, const Report& report, ReportRun& run) {
    const Table table = cut_off_table(report.rows);
    if (table.rows.empty()) return;
    write_table(folder / "cut_offs.csv", table, report.context);
    write_canvas(folder / "cut_offs.png",
                 cut_off_sheet(report.rows, run.references().unbounded(), report.caption));
}

// Writes report.csv, report.json, report.md, the plots, and the maps of errors to the folder of -o.
void write_report(const ReportOptions& options, const Report& report, ReportRun& run) {
    const fs::path& folder = options.output;
    write_atomically(folder / "report.csv", to_csv(report_table(report.rows)));
    write_atomically(folder / "report.md", report_text(report));
    write_json((folder / "report.json").string(), report_json(report, options.shard));
    write_cut_offs(folder, report, run);
    make_output_folder(folder / "errors");
    for (const ReportRow& row : report.rows) {
        check_interrupt();
        write_errors(folder, report, row, run);
    }
    if (report.plots) write_plots(report_plots(report.rows, report.caption), folder);
    note("wrote   " + folder.string());
}

// The values of --quick, unless the command line gives others.
void apply_quick(const CLI::App& command, ReportOptions& options) {
    if (!options.quick) return;
    RenderSettings& s = options.shared.settings;
    if (!is_given(command, "--resolution")) {
        s.width = 480;
        s.height = 270;
    }
    if (!is_given(command, "--lights")) s.lights.count = 1000;
}

// The axis of shadows needs shadows: exact ones, unless the command line asks for others.
void apply_axes(const CLI::App& command, ReportOptions& options) {
    RenderSettings& s = options.shared.settings;
    s.want = {};  // views and AOVs have no error
    const bool shadows = std::ranges::count(options.axes, axis_name(SettingAxis::shadows)) > 0;
    if (!shadows || s.shadows != Shadows::off) return;
    if (is_given(command, "--shadows")) {
        throw UsageError("--axes shadows: needs shadows, and --shadows is off");
    }
    s.shadows = Shadows::exact;
}

// Leaves the first of several devices in the settings.
void take_devices(ReportOptions& options) {
    std::string& device = options.shared.settings.device;
    std::vector<std::string> devices = devices_of(device, options.mixed_devices);
    device = devices.front();
    if (devices.size() > 1) options.devices = std::move(devices);
    refuse_if(options.mixed_devices && options.budget.max_error,
              "--max-error with --mixed-devices: a choice is kept for one kind of device");
    if (options.shard.count == 1) return;
    refuse_if(!options.devices.empty(), "--shard: a shard measures on one device");
    refuse_if(options.budget.max_error.has_value(), "--shard: --max-error needs all settings");
    refuse_if(options.check_default,
              "--check-default: needs all settings; give it to kilolux merge instead");
}

void run_report(ReportOptions& options, const CLI::App& command) {
    refuse_if(options.shared.settings.shading == Shading::illuminance,
              "--shading: report compares radiance; kilolux photometry compares illuminance");
    take_devices(options);
    apply_quick(command, options);
    apply_axes(command, options);
    begin_command(options.shared);
    check_progress(options.shared.progress, options.json);
    note_shard(options.shard);
    make_output_folder(options.output);
    if (!options.output.empty()) load_image_library();
    SharedOptions& shared = options.shared;
    measure_swarm(shared);
    const Scene scene = open_scene(shared);
    const Camera camera = choose_camera(shared, scene);
    const DeviceInfo device = describe(choose_device(shared.settings.device));
    Report report;
    report.plots = !options.output.empty() && can_plot();
    report.context = bench_context(shared, report_frames(options), scene, camera, device);
    report.context["lights"] = shared.settings.lights.count;
    report.context["resolution"] = {shared.settings.width, shared.settings.height};
    const ReportView view{scene, camera, shared.time};
    ReportRun run(view, shared.settings, error_limits(options.budget));
    report.context["error_resolution"] = run.error_size();
    report.caption = report_caption(report.context);
    measure(options, view, run, report);
    print_result(options.json, report_json(report, options.shard), report_text(report));
    if (!options.output.empty()) write_report(options, report, run);
    choose_from_rows(shared, options.budget, view, report.rows);
    if (options.shard.count == 1) judge_default(report.rows, options.check_default);
    const std::string failures = failures_of(report.shares);
    if (!failures.empty()) throw Error(failures + "; the other devices measured the rest");
}

constexpr const char* kReportExamples =
    "  kilolux report -o results\n"
    "  kilolux report --quick\n"
    "  kilolux report town.glb --lights 0 -o results\n"
    "  kilolux report --device all -o results\n"
    "  kilolux report --axes gbuffer,grid --resolution 1280,720 -o results";

}  // namespace

std::string report_caption(const Json& context) {
    const auto size = [](const Json& edges) {
        return fmt::format("{}x{}", edges[0].get<int>(), edges[1].get<int>());
    };
    const Json& scene = context.at("scene");
    return fmt::format(
        "{}, {} lights, {} pixels, errors at {}, {}", scene.at("name").get<std::string>(),
        context.at("lights").get<std::uint64_t>() + scene.at("lights").get<std::uint64_t>(),
        size(context.at("resolution")), size(context.at("error_resolution")),
        context.at("device").at("name").get<std::string>());
}

// "gbuffer half" -> "gbuffer_half".
fs::path error_map_file(const fs::path& folder, std::string setting) {
    for (char& c : setting) {
        if (c == ' ' || c == ',' || c == '/') c = '_';
    }
    return folder / "errors" / (setting + ".png");
}

void judge_default(const std::vector<ReportRow>& rows, bool must_hold) {
    const ReportRow* better = row_that_beats_default(rows);
    if (better == nullptr) return;
    const std::string text = fmt::format(
        "another setting beats the default: {} takes {:.2f} of its time, its R2 RMSE is {:.3g} "
        "for {:.3g}",
        better->setting.name, better->speed.relative, better->surfaces.hdr.rmse,
        rows.front().surfaces.hdr.rmse);
    if (must_hold) throw ComparisonFailed(text);
    warn(text);
}

void visit_settings(ReportOptions& options, const SettingVisitor& f) {
    visit_settings(options.shared, f);
    OptionBuilder(f, "Measuring and output")
        .flag("--quick", options.quick,
              "480x270 pixels, 1000 lights, fewer settings and frames: minutes on two CPU cores")
        .choice_list(
            {"--axes", "", "all; shadows where --shadows asks for some",
             "In what the settings differ, one at a time. shadows: none, exact, and sampled "
             "by 1, 4 and 16 rays; it makes --shadows exact the default"},
            options.axes, setting_axis_names())
        .count({"--warm-up", "N", "2", "Frames before the measured ones, in both rounds", kNeither,
                "1"},
               options.warm_up, {0, 1'000'000})
        .count({"--frames", "N", "20", "Measured frames; slow settings get fewer", kNeither, "1"},
               options.frames, {1, 1'000'000})
        .value({"--shard", "I/N", "0/1", shard_meaning("setting")}, options.shard, parse_shard)
        .flag("--check-default", options.check_default,
              "Exit with 3 where another setting is faster beyond noise and as exact")
        .text({"--output,-o", "DIR", "", "Folder for CSV, JSON, Markdown, plots and pictures"},
              options.output)
        .flag("--mixed-devices", options.mixed_devices,
              "Take devices of several kinds, whose errors may differ in bits; the report notes "
              "which "
              "one measured each setting")
        .flag("--json", options.json, "JSON instead of a table on standard output");
    visit_settings(options.budget, f);
}

void add_report_command(Program& program) {
    program.add_command(
        "report", "Measure speed against error of every setting that trades one for the other",
        kReportExamples, add_options<ReportOptions>, run_report);
}

}  // namespace kilolux
