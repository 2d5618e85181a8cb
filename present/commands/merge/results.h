// SPDX-License-Identifier: Apache-2.0
// The common part of the files of `kilolux merge`.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/base/error.h"
#include "host/measure/bench/table.h"

namespace kilolux {

struct MergeOptions {
    std::filesystem::path output;                // folder
    std::vector<std::filesystem::path> results;  // folders, or their CSV files
    bool keep_differences = false;
    bool check_default = false;
    bool quiet = false;
    bool operator==(const MergeOptions&) const = default;
};

/// What a run of bench or report, or one of its shards, left.
struct Result {
    std::filesystem::path csv;
    nlohmann::ordered_json document;
    TextTable table;
    std::vector<std::string> points{};  // of each row
};

/// Runs `body`; its errors name the file.
template <typename Body>
auto in_file(const std::filesystem::path& file, const Body& body) {
    try {
        return body();
    } catch (const Error& error) {
        throw Error(file.string() + ": " + error.what());
    }
}

/// A row of a result.
struct ResultRow {
    std::size_t result;
    std::size_t row;
};

/// All rows in the order of the sweep, as one run would have written them. Throws Error where a
/// point is missing, does not belong to the sweep, or two results of the same commit, device,
/// driver and tuning have it.
std::vector<ResultRow> rows_in_order(const std::vector<Result>& results);

/// Columns that tell results of different conditions apart.
struct ConditionColumn {
    const char* name;
    const char* path;  // in the context
};
inline constexpr ConditionColumn kConditionColumns[] = {
    {"commit", "/program/commit"}, {"device", "/device/name"}, {"driver", "/device/driver"}};
std::string condition_of(const Result& result, const ConditionColumn& column);

/// The document of what is merged, but for the rows. Values in which the contexts differ become
/// lists.
nlohmann::ordered_json merged_document(const std::vector<Result>& results);

}  // namespace kilolux
