// SPDX-License-Identifier: Apache-2.0
#include "host/base/atomic_write.h"
#include "host/base/interrupt.h"
#include "host/base/log.h"
#include "host/measure/bench/plot.h"
#include "host/measure/report/tables.h"
#include "host/measure/report/worst_pixel.h"
#include "present/cli/stats_json.h"
#include "present/commands/bench.h"
#include "present/commands/report.h"
#include "present/image/image_file.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

// "gbuffer half" -> "gbuffer_half".
std::string file_stem(std::string name) {
    for (char& c : name) {
        if (c == ' ' || c == ',' || c == '/') c = '_';
    }
    return name;
}

void write_worst_pixels(const fs::path& folder, const ReportRow& row, ReportRun& run) {
    const RenderSettings settings = run.at_error_size(row.setting.settings);
    const ReportReferences::All references = run.references().all(settings);
    Frame frame;
    const Canvas canvas = worst_pixel_sheet(row, references);
    frame.width = canvas.width;
    frame.height = canvas.height;
    frame.display = canvas.rgba;
    write_image(folder / (file_stem(row.setting.name) + ".png"), frame);
}

}  // namespace

nlohmann::ordered_json report_json(const Report& report) {
    return {{"context", report.context}, {"rows", table_json(report_table(report.rows))}};
}

void write_report(const ReportOptions& options, const Report& report, ReportRun& run) {
    const fs::path& folder = options.output;
    write_whole_file(folder / "report.csv", to_csv(report_table(report.rows)));
    write_whole_file(folder / "report.md", to_markdown(report_summary(report.rows), 3));
    write_json((folder / "report.json").string(), report_json(report));
    write_plot(surfaces_plot(report.rows), folder / "time_against_error");
    write_plot(unbounded_plot(report.rows), folder / "time_against_unbounded_error");
    make_output_folder(folder / "worst");
    for (const ReportRow& row : report.rows) {
        check_interrupt();
        write_worst_pixels(folder / "worst", row, run);
    }
    note("wrote   " + folder.string());
}

}  // namespace kilolux
