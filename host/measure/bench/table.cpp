// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/table.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/base/error.h"
#include "host/base/text.h"

namespace kilolux {
namespace {

std::string cell_text(const Cell& cell, std::optional<int> significant_digits) {
    if (const auto* text = std::get_if<std::string>(&cell)) return *text;
    if (const auto* count = std::get_if<std::int64_t>(&cell)) return fmt::to_string(*count);
    const auto* value = std::get_if<double>(&cell);
    if (!value) return {};
    return significant_digits ? fmt::format("{:.{}g}", *value, *significant_digits)
                              : fmt::format("{}", *value);
}

void check(const Table& table) {
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        if (table.rows[i].size() == table.columns.size()) continue;
        throw Error(fmt::format("table: row {} has {} cells, must have {}", i, table.rows[i].size(),
                                table.columns.size()));
    }
}

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string doubled;
    for (const char c : text) doubled.append(c == '"' ? 2 : 1, c);
    return fmt::format("\"{}\"", doubled);
}

// A cell must stay on its line and within its bars.
std::string markdown_field(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '|') out += '\\';
        out += c == '\n' || c == '\r' ? ' ' : c;
    }
    return out;
}

bool is_number(const Cell& cell) {
    return std::holds_alternative<double>(cell) || std::holds_alternative<std::int64_t>(cell);
}

// UTF-8 bytes that do not begin a character take no room.
std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
    }));
}

struct MarkdownColumn {
    std::size_t width = 3;
    bool numbers = false;
    std::vector<std::string> fields;  // the header's first
};

MarkdownColumn markdown_column(const Table& table, std::size_t index, int significant_digits) {
    MarkdownColumn out;
    out.fields.push_back(markdown_field(table.columns[index]));
    for (const auto& row : table.rows) {
        out.fields.push_back(markdown_field(cell_text(row[index], significant_digits)));
        out.numbers |= is_number(row[index]);
    }
    for (const std::string& field : out.fields) out.width = std::max(out.width, width_of(field));
    return out;
}

// Takes the first line off a CSV, split at the commas and the end that are not within quotes.
std::vector<std::string> take_csv_line(std::string_view& csv) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    while (!csv.empty()) {
        const char c = csv.front();
        csv.remove_prefix(1);
        if (c == '"' && quoted && csv.starts_with('"')) {
            fields.back() += c;
            csv.remove_prefix(1);
        } else if (c == '"') {
            quoted = !quoted;
        } else if (c == ',' && !quoted) {
            fields.emplace_back();
        } else if (c == '\n' && !quoted) {
            break;
        } else if (c == '\r' && !quoted && csv.starts_with('\n')) {
            continue;  // lines of other systems end in CR LF
        } else {
            fields.back() += c;
        }
    }
    return fields;
}

Cell cell_of_text(const std::string& text) {
    if (text.empty()) return {};
    if (const auto integer = number_of<std::int64_t>(text)) return *integer;
    if (const auto number = number_of<double>(text)) return *number;
    return text;
}

std::string markdown_line(const std::vector<MarkdownColumn>& columns, std::size_t line) {
    std::string out = "|";
    for (const MarkdownColumn& column : columns) {
        const std::string& field = column.fields[line];
        const std::string padding(column.width - width_of(field), ' ');
        out += column.numbers ? fmt::format(" {}{} |", padding, field)
                              : fmt::format(" {}{} |", field, padding);
    }
    return out + "\n";
}

std::string markdown_rule(const std::vector<MarkdownColumn>& columns) {
    std::string out = "|";
    for (const MarkdownColumn& column : columns) {
        out += fmt::format(" {:->{}} |", column.numbers ? ":" : "-", column.width);
    }
    return out + "\n";
}

}  // namespace

std::string to_csv(const Table& table) {
    check(table);
    std::string out;
    const auto append_line = [&](const auto& values, const auto& text) {
        const char* separator = "";
        for (const auto& value : values) {
            out += separator;
            out += csv_field(text(value));
            separator = ",";
        }
        out += '\n';
    };
    append_line(table.columns, [](const std::string& name) { return name; });
    for (const auto& row : table.rows) {
        append_line(row, [](const Cell& cell) { return cell_text(cell, std::nullopt); });
    }
    return out;
}

std::string to_markdown(const Table& table, int significant_digits) {
    check(table);
    std::vector<MarkdownColumn> columns;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        columns.push_back(markdown_column(table, i, significant_digits));
    }
    std::string out = markdown_line(columns, 0) + markdown_rule(columns);
    for (std::size_t i = 0; i < table.rows.size(); ++i) out += markdown_line(columns, i + 1);
    return out;
}

std::string_view whole_lines(std::string_view csv) { return csv.substr(0, csv.rfind('\n') + 1); }

TextTable parse_csv(std::string_view csv) {
    TextTable table;
    if (!csv.empty()) table.columns = take_csv_line(csv);
    while (!csv.empty()) {
        std::vector<std::string> fields = take_csv_line(csv);
        if (fields.size() != table.columns.size()) {
            throw Error(fmt::format("line {}: has {} fields, must have {}", table.rows.size() + 2,
                                    fields.size(), table.columns.size()));
        }
        table.rows.push_back(std::move(fields));
    }
    return table;
}

Table table_of(const TextTable& texts) {
    Table table{texts.columns, {}};
    for (const auto& row : texts.rows) {
        std::vector<Cell>& cells = table.rows.emplace_back();
        for (const std::string& text : row) cells.push_back(cell_of_text(text));
    }
    return table;
}

}  // namespace kilolux
