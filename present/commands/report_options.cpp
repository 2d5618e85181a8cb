// SPDX-License-Identifier: Apache-2.0
#include "present/cli/option_builder.h"
#include "present/commands/report.h"

namespace kilolux {

void add_report_options(CLI::App& command, ReportOptions& options) {
    add_shared_options(command, options.shared);
    OptionBuilder(command, "Measuring and output")
        .flag("--quick", options.quick,
              "480x270 pixels, 1000 lights, fewer settings and frames: about a minute")
        .choice_list({"--axes", "", "all", "What settings may differ in"}, options.axes,
                     setting_axis_names())
        .count({"--warm-up", "N", "2", "Frames before the measured ones, in each of two rounds"},
               options.warm_up, {0, 1'000'000})
        .count({"--frames", "N", "20", "Measured frames; fewer of slow settings"}, options.frames,
               {1, 1'000'000})
        .text({"--output,-o", "DIR", "", "Folder for CSV, JSON, Markdown, plots and pictures"},
              options.output)
        .flag("--json", options.json, "JSON instead of a table on standard output");
    add_budget_options(command, options.budget);
}

}  // namespace kilolux
