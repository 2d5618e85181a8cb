// SPDX-License-Identifier: Apache-2.0
// Certificates as JSON, and back.
#include "present/commands/certify/certify_json.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/base/error.h"
#include "host/base/system/read_text.h"
#include "present/cli/conditions.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

double number_or_infinity(const Json& value) {
    return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
}

Json row_json(const HardCaseRow& row) {
    Json out{{"case", row.hard_case.label},  {"name", row.hard_case.name},
             {"tried", row.hard_case.topic}, {"threshold", row.hard_case.threshold},
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

HardCaseRow row_of_json(const Json& json) {
    const auto label = json.at("case").get<std::string>();
    const auto found = std::ranges::find(hard_cases(), label, &HardCase::label);
    if (found == hard_cases().end()) throw Error("no hard case '" + label + "'");
    HardCaseRow row{*found, json.at("lanes"), {}, json.value("error", "")};
    for (const Json& f : json.at("findings")) {
        row.findings.at_most(
            f.at("what").get<std::string>(),
            Worst{number_or_infinity(f.at("worst")), f.at("checked"), f.at("where")},
            number_or_infinity(f.at("limit")));
    }
    return row;
}

}  // namespace

Json certificate_json(const Json& device, const Certificate& made) {
    Json out{{"program", program_json()}, {"device", device}, {"passed", true}};
    out["failed"] = Json::array();
    out["cases"] = Json::array();
    for (const HardCaseRow& row : made.rows) {
        if (!row.passed()) out["failed"].push_back(row.hard_case.label);
        out["cases"].push_back(row_json(row));
    }
    for (const auto& [name, part] : made.parts.items()) {
        if (!part.at("passed").get<bool>()) out["failed"].push_back(name);
        out[name] = part;
    }
    out["passed"] = out["failed"].empty();
    return out;
}

Json read_certificate(const std::string& file) {
    const std::string text = read_text(file);
    try {
        Json json = Json::parse(text);
        rows_of_json(json);
        json.at("device").at("name");
        json.at("program");
        return json;
    } catch (const std::exception& error) {
        throw Error(file + ": no certificate: " + error.what());
    }
}

std::vector<HardCaseRow> rows_of_json(const Json& certificate) {
    std::vector<HardCaseRow> rows;
    for (const Json& row : certificate.at("cases")) rows.push_back(row_of_json(row));
    return rows;
}

}  // namespace kilolux
