// SPDX-License-Identifier: Apache-2.0
#include "present/commands/report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "host/base/error.h"
#include "host/base/interrupt.h"
#include "host/measure/report/tables.h"
#include "present/cli/frame_summary.h"
#include "present/cli/progress.h"
#include "present/cli/scene_choice.h"
#include "present/cli/stats_json.h"
#include "present/commands/bench.h"
#include "present/commands/commands.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

BenchFrames report_frames(const ReportOptions& options) {
    return {options.warm_up.value_or(options.quick ? 1 : 2),
            options.frames.value_or(options.quick ? 6 : 20)};
}

std::vector<ReportSetting> chosen_settings(const ReportOptions& options, const Scene& scene) {
    const RenderSettings& asked = options.shared.settings;
    auto settings =
        report_settings(scene, asked, describe(choose_device(asked.device)), options.quick);
    if (options.axes.empty()) return settings;
    std::erase_if(settings, [&](const ReportSetting& setting) {
        return setting.axis != SettingAxis::none &&
               std::ranges::find(options.axes, axis_name(setting.axis)) == options.axes.end();
    });
    return settings;
}

std::vector<ReportRow> measure(const ReportOptions& options, ReportRun& run,
                               const std::vector<ReportSetting>& settings) {
    Progress progress("measuring", ReportRun::steps(settings.size()), !options.shared.quiet);
    run.on_step(check_interrupt);
    run.on_progress([&progress] { progress.advance(); });
    std::vector<ReportRow> rows = run.measure(settings, report_frames(options));
    run.on_step([] {});
    run.on_progress([] {});
    return rows;
}

std::string caption_of(const SharedOptions& shared, const DeviceInfo& device,
                       const ReportRun& run) {
    const RenderSettings& s = shared.settings;
    const auto [width, height] = run.error_size();
    return fmt::format("{}, {} lights, {}x{} pixels, errors at {}x{}, {}", shared.scene,
                       s.lights.count, s.width, s.height, width, height, device.name);
}

void run_report(const ReportOptions& options) {
    if (options.shared.quiet && options.shared.verbose) {
        throw UsageError("--quiet and --verbose exclude each other");
    }
    set_verbosity(verbosity_of(options.shared));
    make_output_folder(options.output);
    const SharedOptions& shared = options.shared;
    const Scene scene = open_scene(shared);
    const Camera camera = choose_camera(shared.camera, scene);
    const DeviceInfo device = describe(choose_device(shared.settings.device));
    Report report;
    report.context = bench_context(shared, report_frames(options), scene, camera, device);
    report.context["lights"] = shared.settings.lights.count;
    report.context["resolution"] = {shared.settings.width, shared.settings.height};
    const ReportView view{scene, camera, shared.time};
    ReportRun run(view, shared.settings, error_limits(options.budget));
    report.context["error_resolution"] = run.error_size();
    report.caption = caption_of(shared, device, run);
    report.rows = measure(options, run, chosen_settings(options, scene));
    if (options.json) {
        write_json("-", report_json(report));
    } else {
        std::fputs(report_text(report).c_str(), stdout);
    }
    if (!options.output.empty()) write_report(options, report, run);
    choose_from_rows(shared, options.budget, view, report.rows);
}

// The values of --quick, unless the command line gives others.
void apply_quick(const CLI::App& command, ReportOptions& options) {
    if (!options.quick) return;
    RenderSettings& s = options.shared.settings;
    if (command.get_option("--resolution")->count() == 0) {
        s.width = 480;
        s.height = 270;
    }
    if (command.get_option("--lights")->count() == 0) s.lights.count = 1000;
}

constexpr const char* kExamples =
    "  kilolux report -o results\n"
    "  kilolux report --quick\n"
    "  kilolux report town.glb --lights 0 -o results\n"
    "  kilolux report --axes gbuffer,grid --resolution 1280,720 -o results";

}  // namespace

void add_report_command(Program& program) {
    const auto options = std::make_shared<ReportOptions>();
    const auto command = std::make_shared<CLI::App*>(nullptr);
    *command = &program.add_command(
        "report", "Measure speed against error of every setting that trades one for the other",
        kExamples, [options, command] {
            apply_quick(**command, *options);
            run_report(*options);
        });
    add_report_options(**command, *options);
}

}  // namespace kilolux
