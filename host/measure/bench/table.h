// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kilolux {

/// A table's entry; monostate: not measured, shown as an empty field.
using Cell = std::variant<std::monostate, std::string, double, std::int64_t>;

/// A report: named columns and rows of as many cells.
struct Table {
    std::vector<std::string> columns;  // with their unit, e.g. "shade [ms]"
    std::vector<std::vector<Cell>> rows;
};

/// RFC 4180 with LF line ends and a header line. Numbers are the shortest text that reads back as
/// the same double; "nan", "inf", "-inf". Throws Error when a row has not as many cells as there
/// are columns.
std::string to_csv(const Table& table);

/// A Markdown table with columns padded to their width, numbers to the right, doubles with
/// `significant_digits`. Throws as to_csv().
std::string to_markdown(const Table& table, int significant_digits = 4);

/// A CSV's texts.
struct TextTable {
    std::vector<std::string> columns;  // empty: an empty file
    std::vector<std::vector<std::string>> rows;
};

/// Reads RFC 4180. Throws Error with the number of a line that has not as many fields as the first.
TextTable parse_csv(std::string_view csv);

/// The same with fields that are numbers as numbers, and empty ones as not measured.
Table table_of(const TextTable& texts);

}  // namespace kilolux
