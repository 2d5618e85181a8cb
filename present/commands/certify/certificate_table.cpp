// SPDX-License-Identifier: Apache-2.0
// The table of certificates in Markdown.
#include "present/commands/certify/certificate_table.h"

#include <fmt/format.h>
#include <filesystem>

#include "host/base/error.h"
#include "host/measure/bench/table.h"
#include "host/measure/roofline/stage_report.h"
#include "present/commands/certify/certificate.h"
#include "present/commands/certify/certify.h"
#include "present/commands/certify/certify_json.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Certified {
    std::string stem;
    Json json;
    std::vector<HardCaseRow> rows;
};

Certified read(const std::string& file) {
    const Json json = read_certificate(file);
    if (json.contains(kUnfinished)) {
        throw Error(fmt::format("{}: unfinished: {} processes had not ended; --resume goes on",
                                file, json.at(kUnfinished).dump()));
    }
    return {fs::path(file).stem().string(), json, rows_of_json(json)};
}

std::string word(const Certified& c, const char* path) {
    const Json& value = c.json.at(Json::json_pointer(path));
    return value.is_string() ? value.get<std::string>() : value.dump();
}

// An empty field for a part that was not made.
Cell part_cell(const Certified& c, const char* name) {
    if (!c.json.contains(name)) return {};
    const Json& part = c.json[name];
    if (!part.value("ran", true)) return part.value("why", "not run");
    return std::string(part.at("passed").get<bool>() ? "passed" : "FAILED");
}

Cell frame_ms(const Certified& c) {
    for (const Json& row : c.json.value("/stages/rows"_json_pointer, Json::array())) {
        if (row.at("stage") == kFrameStage.name) return row.at("median_ms").get<double>();
    }
    return {};
}

Cell source_cell(const Certified& c) {
    const Json source = c.json.value("/tuning/source"_json_pointer, Json());
    return source.is_null() ? Cell() : Cell(source.get<std::string>());
}

std::string passed_cases(const Certified& c) {
    const auto passed = std::ranges::count_if(c.rows, &HardCaseRow::passed);
    return fmt::format("{} of {}", passed, c.rows.size());
}

std::string lane_widths(const Certified& c) {
    std::string out;
    if (c.rows.empty()) return out;
    for (const int width : c.rows.front().lanes)
        out += fmt::format("{}{}", out.empty() ? "" : ", ", width);
    return out;
}

// The instruction set of the code: the environment may ask for another than the processor's widest.
std::string code(const Certified& c) {
    std::string out = word(c, "/device/version");
    for (const Json& variable : c.json.at("device").at("environment"))
        out += ", " + variable.get<std::string>();
    return out;
}

Table summary(const std::vector<Certified>& all) {
    using C = Certified;
    return make_table<C>(
        {{"certificate", [](const C& c) { return fmt::format("[{0}]({0}.json)", c.stem); }},
         {"device", [](const C& c) { return word(c, "/device/name"); }},
         {"driver",
          [](const C& c) { return word(c, "/device/platform") + " " + word(c, "/device/driver"); }},
         {"version, environment", code},
         {"cases passed", passed_cases},
         {"lanes", lane_widths},
         {"lists = all lights", [](const C& c) { return part_cell(c, "equality"); }},
         {"oclgrind", [](const C& c) { return part_cell(c, "oclgrind"); }},
         {"frame [ms]", frame_ms},
         {"tuning", source_cell},
         {"commit", [](const C& c) { return word(c, "/program/commit"); }}},
        all);
}

// A failed case's error, or its findings beyond their limits.
std::string failure(const HardCaseRow& row) {
    std::string text = row.error;
    for (const Finding& f : row.findings.all()) {
        if (!f.passed()) text += (text.empty() ? "" : "; ") + finding_text(f);
    }
    return fmt::format("* {} {}: {}\n", row.hard_case.label, row.hard_case.name, text);
}

// In the words of the program of that commit.
std::string failures(const Certified& c) {
    std::string out;
    for (const HardCaseRow& row : c.rows) {
        if (!row.passed()) out += failure(row);
    }
    for (const CertificatePart& part : certificate_parts()) {
        const Json found = c.json.value(part.name, Json());
        if (found.is_null() || found.at("passed").get<bool>()) continue;
        out += fmt::format("* {}: {}\n", part.name, found.value("error", "see the certificate"));
    }
    if (out.empty()) return out;
    return fmt::format("\n## {}: failures of commit {}\n\n{}", c.stem, word(c, "/program/commit"),
                       out);
}

}  // namespace

std::string certificates_text(const std::vector<std::string>& files) {
    std::vector<Certified> all;
    for (const std::string& file : files) all.push_back(read(file));
    std::string out =
        "<!-- Written by host/certify/devices/make_table; do not edit. -->\n# Certificates\n\n" +
        to_markdown(summary(all)) +
        "\nFrame: the atrium, 960x540, 1000 lights, OpenCL draws its triangles; lights and camera "
        "move.\n";
    for (const Certified& c : all) out += failures(c);
    return out;
}

}  // namespace kilolux
