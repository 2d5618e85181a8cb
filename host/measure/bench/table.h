// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace kilolux {

/// A table's entry; monostate: not measured, shown as an empty field.
using Cell = std::variant<std::monostate, std::string, double, std::int64_t>;

/// The entry for a number, a text or a Cell; an optional that is empty was not measured.
template <typename Value>
Cell cell_of(const Value& value) {
    if constexpr (std::integral<Value>) {
        return static_cast<std::int64_t>(value);
    } else if constexpr (std::convertible_to<Value, std::string_view>) {
        return std::string(value);
    } else {
        return value;
    }
}
template <typename Value>
Cell cell_of(const std::optional<Value>& value) {
    return value ? cell_of(*value) : Cell();
}

/// A report: named columns and rows of as many cells.
struct Table {
    std::vector<std::string> columns;  // with their unit, e.g. "shade [ms]"
    std::vector<std::vector<Cell>> rows;
};

/// A column by its name and the value that it shows of a row: a member or a function.
template <typename Row>
struct Column {
    template <typename Value>
    Column(std::string column_name, Value value)
        : name(std::move(column_name)),
          cell([value](const Row& row) { return cell_of(std::invoke(value, row)); }) {}

    std::string name;
    std::function<Cell(const Row&)> cell;
};

template <typename Row>
Table make_table(const std::vector<Column<Row>>& columns, const std::vector<Row>& rows) {
    Table table;
    for (const Column<Row>& column : columns) table.columns.push_back(column.name);
    for (const Row& row : rows) {
        std::vector<Cell>& cells = table.rows.emplace_back();
        for (const Column<Row>& column : columns) cells.push_back(column.cell(row));
    }
    return table;
}

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

/// A CSV without a last line that does not end: a copied file may end within one.
std::string_view whole_lines(std::string_view csv);

/// Reads RFC 4180. Throws Error with the number of a line that has not as many fields as the first.
TextTable parse_csv(std::string_view csv);

/// The same with fields that are numbers as numbers, and empty ones as not measured.
Table table_of(const TextTable& texts);

}  // namespace kilolux
