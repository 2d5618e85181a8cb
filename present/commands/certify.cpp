// SPDX-License-Identifier: Apache-2.0
#include "present/commands/certify.h"

#include <cmath>
#include <cstdio>
#include <set>

#include "host/base/atomic_write.h"
#include "host/base/error.h"
#include "host/base/interrupt.h"
#include "host/base/suggest.h"
#include "present/cli/option_builder.h"
#include "present/cli/progress.h"
#include "present/cli/stats_json.h"
#include "present/commands/bench.h"
#include "present/program.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

struct CertifyOptions {
    std::string device;
    std::vector<int> lanes = {1, 2, 4, 8, 16};
    std::set<std::size_t> cases;  // places in hard_cases(); empty: all
    std::string output;           // file, "-" for standard output, empty: none
    bool quiet = false;
};

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json row_json(const HardCaseRow& row) {
    Json out{{"case", row.hard_case.label},  {"name", row.hard_case.name},
             {"tried", row.hard_case.tried}, {"threshold", row.hard_case.threshold},
             {"lanes", row.lanes},           {"passed", row.passed()}};
    if (!row.error.empty()) out["error"] = row.error;
    out["findings"] = Json::array();
    for (const Finding& f : row.findings.all()) {
        out["findings"].push_back({{"what", f.what},
                                   {"worst", finite_or_null(f.value)},
                                   {"limit", finite_or_null(f.limit)},
                                   {"checked", f.checked},
                                   {"where", f.where}});
    }
    return out;
}

std::vector<HardCase> chosen_cases(const CertifyOptions& options) {
    const auto all = hard_cases();
    if (options.cases.empty()) return {all.begin(), all.end()};
    std::vector<HardCase> cases;
    for (const std::size_t place : options.cases) cases.push_back(all[place]);
    return cases;
}

void run_certify(const CertifyOptions& options) {
    if (!options.output.empty() && options.output != "-") check_can_write(options.output);
    const std::vector<HardCase> cases = chosen_cases(options);
    const Gpu gpu(choose_device(options.device));
    std::vector<HardCaseRow> rows;
    {
        Progress progress("hard cases", cases.size() * options.lanes.size(), !options.quiet);
        rows = run_hard_cases(gpu, cases, options.lanes, [&] {
            check_interrupt();
            progress.advance();
        });
    }
    if (!options.output.empty()) write_json(options.output, certificate_json(gpu.info, rows));
    if (options.output != "-") std::fputs(to_markdown(hard_case_table(rows)).c_str(), stdout);
    require_all_passed(rows);
}

// Labels, then names; the place of either modulo the number of cases is that of the case.
std::vector<std::string> labels_and_names() {
    std::vector<std::string> words;
    for (const HardCase& c : hard_cases()) words.emplace_back(c.label);
    for (const HardCase& c : hard_cases()) words.emplace_back(c.name);
    return words;
}

void add_certify_options(CLI::App& command, CertifyOptions& options) {
    using Text = const std::string&;
    OptionBuilder(command, "What is run")
        .value({"--case", "NAME,...", "all", "Cases by name or label, e.g. tiny-lights,M3"},
               [&options](Text name, Text text) {
                   const auto words = labels_and_names();
                   for (const std::string& word : parse_name_list(name, text, words)) {
                       options.cases.insert(parse_name(name, word, words) % hard_cases().size());
                   }
               })
        .text({"--device", "NAME-OR-INDEX", "best", "OpenCL device"}, options.device)
        .value({"--lanes", "1|2|4|8|16,...", "1,2,4,8,16", "Lane widths that every case runs at"},
               [&options](Text name, Text text) {
                   options.lanes.clear();
                   for (const std::string& width :
                        parse_name_list(name, text, {"1", "2", "4", "8", "16"})) {
                       options.lanes.push_back(std::stoi(width));
                   }
               })
        .question("--list-devices", "Print the OpenCL devices and leave");
    OptionBuilder(command, "Output")
        .text({"--output,-o", "FILE", "",
               "Write the result as JSON; - prints it instead of the table"},
              options.output)
        .flag("--quiet", options.quiet, "No progress bar");
}

constexpr const char* kExamples =
    "  kilolux certify\n"
    "  kilolux certify --device 1 -o device1.json\n"
    "  kilolux certify --case long-sums,M3 --lanes 8\n"
    "  kilolux certify --quiet -o - > result.json";

}  // namespace

Json certificate_json(const DeviceInfo& device, const std::vector<HardCaseRow>& rows) {
    Json out{{"program", program_json()}, {"device", device_json(device)}, {"passed", true}};
    out["failed"] = Json::array();
    out["cases"] = Json::array();
    for (const HardCaseRow& row : rows) {
        if (!row.passed()) out["failed"].push_back(row.hard_case.label);
        out["cases"].push_back(row_json(row));
    }
    out["passed"] = out["failed"].empty();
    return out;
}

void require_all_passed(const std::vector<HardCaseRow>& rows) {
    std::vector<std::string> failed;
    for (const HardCaseRow& row : rows) {
        const HardCase& c = row.hard_case;
        if (!row.passed()) failed.push_back(std::string(c.label) + " " + std::string(c.name));
    }
    if (failed.empty()) return;
    throw ComparisonFailed("certify: " + std::to_string(failed.size()) + " of " +
                           std::to_string(rows.size()) + " hard cases failed: " + joined(failed));
}

void add_certify_command(Program& program) {
    program.add_command("certify",
                        "Run the numerically hard cases on a device; exit 3 where one fails",
                        kExamples, add_certify_options, run_certify);
}

}  // namespace kilolux
