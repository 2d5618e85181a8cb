// SPDX-License-Identifier: Apache-2.0
#include "host/base/text.h"
#include "present/cli/option_builder.h"
#include "present/commands/report.h"

namespace kilolux {

void add_report_options(CLI::App& command, ReportOptions& options) {
    using Text = const std::string&;
    add_shared_options(command, options.shared);
    OptionBuilder(command, "Measuring and output")
        .flag("--quick", options.quick,
              "480x270 pixels, 1000 lights, fewer settings and frames: about a minute")
        .value({"--axes", joined(setting_axis_names(), "|") + ",...", "all",
                "What settings may differ in"},
               [&options](Text name, Text text) {
                   options.axes = parse_name_list(name, text, setting_axis_names());
               })
        .value({"--warm-up", "N", "2", "Frames before the measured ones, in each of two rounds"},
               [&options](Text name, Text text) {
                   options.warm_up = static_cast<int>(parse_count(name, text, {0, 1000000}));
               })
        .value({"--frames", "N", "20", "Measured frames; fewer of slow settings"},
               [&options](Text name, Text text) {
                   options.frames = static_cast<int>(parse_count(name, text, {1, 1000000}));
               })
        .value({"--output,-o", "DIR", "", "Folder for CSV, JSON, Markdown, plots and pictures"},
               [&options](Text, Text text) { options.output = text; })
        .flag("--json", options.json, "JSON instead of a table on standard output");
    add_budget_options(command, options.budget);
}

}  // namespace kilolux
