// SPDX-License-Identifier: Apache-2.0
#include "present/commands/merge/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <unordered_map>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/text.h"
#include "present/commands/bench/bench.h"
#include "present/commands/bench/bench_context.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

// The conditions under which a result was measured: a line to show, then the tuning.
std::string conditions_of(const Result& result) {
    std::vector<std::string> parts;
    for (const ConditionColumn& column : kConditionColumns)
        parts.push_back(fmt::format("{} {}", column.name, condition_of(result, column)));
    return joined(parts) + "\n" + result.document.at("context").at("tuning").dump();
}

// The result of these rows that was measured under each conditions. Throws where two were.
std::map<std::string, std::size_t> result_by_conditions(const std::vector<Result>& results,
                                                        const std::string& point,
                                                        const std::vector<ResultRow>& rows) {
    std::map<std::string, std::size_t> out;
    for (const ResultRow& row : rows) {
        const auto [found, is_new] =
            out.try_emplace(conditions_of(results[row.result]), row.result);
        if (is_new || found->second == row.result) continue;
        throw Error(fmt::format("{} and {}: both have the point '{}'",
                                results[found->second].csv.string(),
                                results[row.result].csv.string(), point));
    }
    return out;
}

// Throws where no result has a point.
void refuse_missing(const std::vector<std::string>& missing, std::size_t points) {
    if (missing.empty()) return;
    constexpr std::size_t kNamed = 3;
    std::string names;
    for (std::size_t i = 0; i < std::min(kNamed, missing.size()); ++i)
        names += fmt::format("{}'{}'", i > 0 ? ", " : "", missing[i]);
    throw Error(fmt::format("{} of {} points are in no result: {}{}", missing.size(), points, names,
                            missing.size() > kNamed ? ", ..." : ""));
}

// Results of other conditions may complete each other: what each set of them lacks is said.
void warn_of_missing(const std::map<std::string, std::size_t>& lacking, std::size_t points) {
    if (lacking.size() < 2) return;
    for (const auto& [conditions, count] : lacking) {
        if (count > 0)
            warn(fmt::format("{}: {} of {} points are missing",
                             conditions.substr(0, conditions.find('\n')), count, points));
    }
}

// `was` and `is` as a list, without repetition.
Json listed(Json was, const Json& is) {
    if (!was.is_array()) was = Json::array({was});
    if (std::ranges::find(was, is) == was.end()) was.push_back(is);
    return was;
}

}  // namespace

std::vector<ResultRow> rows_in_order(const std::vector<Result>& results) {
    const auto points = results.front().document.at("points").get<std::vector<std::string>>();
    std::unordered_map<std::string, std::vector<ResultRow>> found;
    for (const std::string& point : points) found[point];
    for (std::size_t i = 0; i < results.size(); ++i) {
        for (std::size_t row = 0; row < results[i].points.size(); ++row) {
            const auto place = found.find(results[i].points[row]);
            if (place == found.end()) {
                throw Error(fmt::format("{}: has '{}', which is no point of its sweep",
                                        results[i].csv.string(), results[i].points[row]));
            }
            place->second.push_back({i, row});
        }
    }
    std::map<std::string, std::size_t> lacking;  // points, by conditions
    for (const Result& result : results) lacking[conditions_of(result)] = 0;
    std::vector<ResultRow> out;
    std::vector<std::string> missing;
    for (const std::string& point : points) {
        const std::vector<ResultRow>& rows = found[point];
        const auto measured = result_by_conditions(results, point, rows);
        if (rows.empty()) missing.push_back(point);
        for (auto& [conditions, count] : lacking) count += measured.contains(conditions) ? 0 : 1;
        out.insert(out.end(), rows.begin(), rows.end());
    }
    refuse_missing(missing, points.size());
    warn_of_missing(lacking, points.size());
    return out;
}

std::string condition_of(const Result& result, const ConditionColumn& column) {
    return result.document.at("context").at(Json::json_pointer(column.path)).get<std::string>();
}

Json merged_document(const std::vector<Result>& results) {
    const Json& first = results.front().document;
    Json context = first.at("context"), parts = Json::array();
    for (const Result& result : results) {
        const Json values = result.document.at("context").flatten();
        for (const auto& [path, value] : values.items()) {
            if (value.is_null()) continue;  // an empty object or list
            const Json::json_pointer place(path);
            if (!context.contains(place) || context[place] != value)
                context[place] = listed(context.contains(place) ? context[place] : Json(), value);
        }
        parts.push_back({{"shard", result.document.value("shard", "0/1")},
                         {"command", result.document.value("command", "")}});
        if (result.document.contains("limits")) parts.back()["limits"] = result.document["limits"];
    }
    Json out = result_document(context, first.at("points").get<std::vector<std::string>>(), {});
    out["parts"] = std::move(parts);
    return out;
}

}  // namespace kilolux
