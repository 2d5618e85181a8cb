// SPDX-License-Identifier: Apache-2.0
#include "present/commands/certify/certify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/atomic_write.h"
#include "host/base/system/interrupt.h"
#include "host/base/text.h"
#include "host/render/plan/kernel_choice.h"
#include "present/cli/conditions.h"
#include "present/cli/option_builder.h"
#include "present/cli/progress.h"
#include "present/cli/stats_json.h"
#include "present/commands/certify/certificate.h"
#include "present/commands/certify/certificate_table.h"
#include "present/commands/certify/certify_isolated.h"
#include "present/commands/certify/certify_json.h"
#include "present/program.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

void check(const CertifyOptions& o) {
    if (!o.tables.empty() && (o.cases || !o.parts.empty() || o.isolate || o.jobs > 1 || o.resume ||
                              o.quick || !o.output.empty())) {
        throw UsageError(
            "--table: prints what was certified; it goes with no --quick, --case, --with, "
            "--isolate, --jobs, --resume or -o");
    }
    check_progress(o.progress, o.output == "-");
    refuse_if(o.resume && (o.output.empty() || o.output == "-"),
              "--resume: goes on with the file of -o, which is not given");
}

std::size_t place_of_part(std::string_view name) {
    const auto parts = certificate_parts();
    return static_cast<std::size_t>(std::ranges::find(parts, name, &CertificatePart::name) -
                                    parts.begin());
}

// The values of --quick, unless the command line gives others.
void apply_quick(const CLI::App& command, const cl::Device& device, CertifyOptions& options) {
    if (!options.quick) return;
    if (!is_given(command, "--lanes"))
        options.lanes = {choose_tuning(describe(device), KernelSettings{}).lanes};
    if (!is_given(command, "--with")) options.parts = {place_of_part("equality")};
}

// What this run has not tried.
std::string not_tried_text(const CertifyOptions& options) {
    std::vector<std::string> words;
    for (const int width : kLaneWidths) {
        if (std::ranges::count(options.lanes, width) == 0)
            words.push_back(fmt::format("{} {}", width, width == 1 ? "lane" : "lanes"));
    }
    for (std::size_t i = 0; i < certificate_parts().size(); ++i) {
        if (!options.parts.contains(i)) words.emplace_back(certificate_parts()[i].name);
    }
    if (options.cases && options.cases->size() < hard_cases().size())
        words.push_back(fmt::format("{} cases", hard_cases().size() - options.cases->size()));
    return words.empty() ? "" : "\nnot tried: " + joined(words) + "\n";
}

std::vector<HardCase> chosen_cases(const CertifyOptions& options) {
    const auto all = hard_cases();
    if (!options.cases) return {all.begin(), all.end()};
    std::vector<HardCase> cases;
    for (const std::size_t place : *options.cases) cases.push_back(all[place]);
    return cases;
}

// What the file of an interrupted run holds; nothing where there is none. Throws UsageError for
// another device's or program's.
Certificate found_before(const CertifyOptions& options, const Json& device) {
    Certificate out;
    if (!options.resume || !std::filesystem::exists(options.output)) return out;
    const Json former = read_certificate(options.output);
    const auto require_same = [&](const char* key, const char* part, const Json& now) {
        const Json then = former.at(key).value(part, Json());
        if (then == now.at(part)) return;
        throw UsageError(fmt::format("--resume: {} was made by another {}: its {} is {}, now {}",
                                     options.output, key, part, then.dump(), now.at(part).dump()));
    };
    for (const char* part : {"name", "platform", "version", "driver", "environment"}) {
        require_same("device", part, device);
    }
    require_same("program", "commit", program_json());
    out.rows = rows_of_json(former);
    for (const CertificatePart& part : certificate_parts()) {
        if (former.contains(part.name)) out.parts[part.name] = former.at(part.name);
    }
    return out;
}

// Writes what was found while `left` processes have not ended.
void keep(const CertifyOptions& options, const Json& device, Certificate found, std::size_t left) {
    if (options.output.empty() || options.output == "-" || left == 0) return;
    std::erase_if(found.rows, [](const HardCaseRow& row) { return row.lanes.empty(); });
    Json json = certificate_json(device, found);
    json["passed"] = false;
    json[kUnfinished] = left;
    write_json(options.output, json);
}

// Runs the processes; after each its findings are in the file of -o.
Certificate make_isolated(const CertifyOptions& options, const IsolatedRequest& request,
                          const cl::Device& device) {
    const Json capabilities = capabilities_json(device);
    std::optional<Progress> progress;
    const auto on_begin = [&](const Certificate&, std::size_t left) {
        progress.emplace("certifying", left, options.shown_progress());
    };
    const auto on_done = [&](const Certificate& found, std::size_t left) {
        keep(options, capabilities, found, left);
        check_interrupt();
        progress->advance();
    };
    return certify_isolated(request, found_before(options, capabilities), on_begin, on_done);
}

// Makes all that the command line asks for, in this process or in others.
Certificate make_certificate(const CertifyOptions& options, const cl::Device& device) {
    const std::vector<HardCase> cases = chosen_cases(options);
    std::vector<CertificatePart> parts;
    for (const std::size_t place : options.parts) parts.push_back(certificate_parts()[place]);
    if (options.isolate || options.jobs > 1 || options.resume) {
        return make_isolated(options, {options.device, cases, options.lanes, parts, options.jobs},
                             device);
    }
    Certificate out;
    Progress progress("certifying", cases.size() * options.lanes.size() + parts.size(),
                      options.shown_progress());
    const auto step = [&] {
        check_interrupt();
        progress.advance();
    };
    out.rows = run_hard_cases(Gpu(device), cases, options.lanes, step);
    for (const CertificatePart& part : parts) {
        out.parts[part.name] = made_part(part, device, check_interrupt);
        step();
    }
    return out;
}

std::string parts_text(const nlohmann::ordered_json& parts) {
    std::string out;
    for (const auto& [name, part] : parts.items()) {
        out += (out.empty() ? "\n" : "") + name + ": " +
               (part.at("passed").get<bool>() ? "passed" : "FAILED") +
               (part.contains("error") ? ": " + part["error"].get<std::string>() : "") + "\n";
    }
    return out;
}

void run_certify(CertifyOptions& options, const CLI::App& command) {
    check(options);
    if (!options.tables.empty()) {
        std::fputs(certificates_text(options.tables).c_str(), stdout);
        return;
    }
    set_verbosity(Verbosity::quiet);  // for the scenes of the parts
    if (!options.output.empty() && options.output != "-") check_can_write(options.output);
    const cl::Device device = choose_device(options.device);
    apply_quick(command, device, options);
    const Certificate made = make_certificate(options, device);
    if (!options.output.empty()) {
        write_json(options.output, certificate_json(capabilities_json(device), made));
    }
    if (options.output != "-") {
        if (!made.rows.empty()) std::fputs(to_markdown(hard_case_table(made.rows)).c_str(), stdout);
        std::fputs(parts_text(made.parts).c_str(), stdout);
        if (options.quick) std::fputs(not_tried_text(options).c_str(), stdout);
    }
    require_all_passed(made);
}

// Labels, then names; an index modulo the number of cases is that of the case.
std::vector<std::string> labels_and_names() {
    std::vector<std::string> words;
    for (const HardCase& c : hard_cases()) words.emplace_back(c.label);
    for (const HardCase& c : hard_cases()) words.emplace_back(c.name);
    return words;
}

std::vector<std::string> part_names() {
    std::vector<std::string> words;
    for (const CertificatePart& part : certificate_parts()) words.emplace_back(part.name);
    words.emplace_back("all");
    return words;
}

void visit_run(CertifyOptions& options, const SettingVisitor& f) {
    using Text = const std::string&;
    OptionBuilder(f, "What is run")
        .flag("--quick", options.quick,
              "A node's admission test: every case at the device's lane width, and equality. Takes "
              "20 s on two CPU cores once the kernels are cached")
        .value(SettingKind::list,
               {"--case", "NAME,...", "all",
                "Cases by name or label, e.g. tiny-lights,M3; none for none"},
               [&options](Text name, Text text) {
                   options.cases.emplace();
                   if (text == "none") return;
                   const auto words = labels_and_names();
                   for (const std::string& word : parse_name_list(name, text, words)) {
                       options.cases->insert(parse_name(name, word, words) % hard_cases().size());
                   }
               },
               {})
        .text({"--device", "NAME-OR-INDEX", "best", "OpenCL device"}, options.device)
        .value(SettingKind::list,
               {"--lanes", "1|2|4|8|16,...", "1,2,4,8,16", "Lane widths that every case runs at"},
               [&options](Text name, Text text) {
                   options.lanes.clear();
                   for (const std::string& width :
                        parse_name_list(name, text, {"1", "2", "4", "8", "16"})) {
                       options.lanes.push_back(std::stoi(width));
                   }
               },
               {})
        .value(SettingKind::list,
               {"--with", "NAME,...|all", "",
                "Also: equality (pictures by lists against those by all lights), oclgrind (a "
                "frame's kernels), stages (times of a frame), tuning"},
               [&options](Text name, Text text) {
                   const auto words = part_names();
                   for (const std::string& word : parse_name_list(name, text, words)) {
                       const std::size_t place = parse_name(name, word, words);
                       for (std::size_t i = 0; i + 1 < words.size(); ++i)
                           if (word == "all" || i == place) options.parts.insert(i);
                   }
               },
               {})
        .flag("--isolate", options.isolate,
              "Each in a process of its own: a driver that ends the process fails one of them")
        .count({"--jobs", "N", "1",
                "Processes at once, as with --isolate, at most the machine's threads; for GPUs, "
                "where nearly all time is that of compiling",
                kNeither, "1"},
               options.jobs, {1, 1024})
        .flag("--resume", options.resume,
              "Go on with the file of -o, which holds what an interrupted run with --isolate or "
              "--jobs found");
}

void visit_result(CertifyOptions& options, const SettingVisitor& f) {
    using Text = const std::string&;
    OptionBuilder(f, "Output")
        .text({"--output,-o", "FILE", "",
               "Write the result as JSON; - prints it instead of the table"},
              options.output)
        .value(SettingKind::list,
               {"--table", "FILE,...", "", "Print the table of certificates (-o FILE)"},
               [&options](Text, Text text) {
                   for (const std::string_view file : split(text, ',')) {
                       options.tables.emplace_back(file);
                   }
               },
               {})
        .choice({"--progress", "", "", "How it tells how far it is"}, options.progress)
        .flag("--quiet", options.quiet, "No progress bar");
}

constexpr const char* kCertifyExamples =
    "  kilolux certify\n"
    "  kilolux certify --quick\n"
    "  kilolux certify --device 1 --with all -o device1.json\n"
    "  kilolux certify --case long-sums,M3 --lanes 8\n"
    "  kilolux certify --quiet -o - > result.json";

}  // namespace

void require_all_passed(const Certificate& made) {
    std::vector<std::string> failed;
    for (const HardCaseRow& row : made.rows) {
        const HardCase& c = row.hard_case;
        if (!row.passed()) failed.push_back(std::string(c.label) + " " + std::string(c.name));
    }
    std::string text;
    if (!failed.empty()) {
        text = fmt::format("{} of {} hard cases failed: {}", failed.size(), made.rows.size(),
                           joined(failed));
    }
    for (const auto& [name, part] : made.parts.items()) {
        if (!part.at("passed").get<bool>()) text += (text.empty() ? "" : "; ") + name + " failed";
    }
    if (!text.empty()) throw ComparisonFailed("certify: " + text);
}

void visit_settings(CertifyOptions& options, const SettingVisitor& f) {
    visit_run(options, f);
    visit_result(options, f);
}

void add_certify_command(Program& program) {
    program.add_command("certify",
                        "Run the numerically hard cases on a device; exit 3 where one fails",
                        kCertifyExamples, add_options<CertifyOptions>, run_certify);
}

}  // namespace kilolux
