// SPDX-License-Identifier: Apache-2.0
#include "host/base/atomic_write.h"
#include "host/base/interrupt.h"
#include "host/base/log.h"
#include "host/measure/bench/plot.h"
#include "host/measure/report/error_sheets.h"
#include "host/measure/report/tables.h"
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

void write_canvas(const fs::path& file, Canvas canvas) {
    Frame frame;
    frame.width = canvas.width;
    frame.height = canvas.height;
    frame.display = std::move(canvas.rgba);
    write_image(file, frame);
}

void write_errors(const fs::path& folder, const Report& report, const ReportRow& row,
                  ReportRun& run) {
    const auto references = run.references().all(run.at_error_size(row.setting.settings));
    const std::string file = file_stem(row.setting.name) + ".png";
    write_canvas(folder / "worst" / file, worst_pixel_sheet(row, references, report.caption));
    write_canvas(folder / "errors" / file, error_map_sheet(row, references, report.caption));
}

}  // namespace

std::string report_text(const Report& report) {
    return to_markdown(report_summary(report.rows), 3) + "\n" + report_notes(report.rows);
}

nlohmann::ordered_json report_json(const Report& report) {
    return {{"context", report.context}, {"rows", table_json(report_table(report.rows))}};
}

void write_report(const ReportOptions& options, const Report& report, ReportRun& run) {
    const fs::path& folder = options.output;
    write_atomically(folder / "report.csv", to_csv(report_table(report.rows)));
    write_atomically(folder / "report.md", report_text(report));
    write_json((folder / "report.json").string(), report_json(report));
    write_plot(surfaces_plot(report.rows, report.caption), folder / "time_against_error");
    write_plot(unbounded_plot(report.rows, report.caption),
               folder / "time_against_unbounded_error");
    make_output_folder(folder / "worst");
    make_output_folder(folder / "errors");
    for (const ReportRow& row : report.rows) {
        check_interrupt();
        write_errors(folder, report, row, run);
    }
    note("wrote   " + folder.string());
}

}  // namespace kilolux
