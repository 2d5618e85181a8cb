// SPDX-License-Identifier: Apache-2.0
#include "present/commands/merge/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_map>

#include "host/base/error.h"
#include "host/base/text.h"
#include "present/commands/bench.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

bool have_same_conditions(const Result& a, const Result& b) {
    return std::ranges::all_of(kConditionColumns, [&](const ConditionColumn& column) {
        return condition_of(a, column) == condition_of(b, column);
    });
}

// Throws where two results measured a point, of which these are the rows, under the same
// conditions.
void refuse_doubled(const std::vector<Result>& results, const std::string& point,
                    const std::vector<ResultRow>& rows) {
    std::set<std::size_t> seen;
    for (const ResultRow& row : rows) {
        if (!seen.insert(row.result).second) continue;
        for (const std::size_t other : seen) {
            const Result &a = results[other], &b = results[row.result];
            if (other == row.result || !have_same_conditions(a, b)) continue;
            throw Error(fmt::format("{} and {}: both have the point '{}'", a.csv.string(),
                                    b.csv.string(), point));
        }
    }
}

[[noreturn]] void refuse_missing(const std::vector<std::string>& missing, std::size_t points) {
    constexpr std::size_t kNamed = 3;
    std::string names;
    for (std::size_t i = 0; i < std::min(kNamed, missing.size()); ++i)
        names += fmt::format("{}'{}'", i > 0 ? ", " : "", missing[i]);
    throw Error(fmt::format("{} of {} points are in no result: {}{}", missing.size(), points, names,
                            missing.size() > kNamed ? ", ..." : ""));
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
    std::vector<ResultRow> out;
    std::vector<std::string> missing;
    for (const std::string& point : points) {
        const std::vector<ResultRow>& rows = found[point];
        if (rows.empty()) missing.push_back(point);
        refuse_doubled(results, point, rows);
        out.insert(out.end(), rows.begin(), rows.end());
    }
    if (!missing.empty()) refuse_missing(missing, points.size());
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
