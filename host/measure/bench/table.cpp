// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "host/base/error.h"

namespace kilolux {
namespace {

// Independent of the locale. Without digits: the shortest text that reads back as the same double.
std::string number_text(double value, std::optional<int> significant_digits) {
    std::array<char, 64> buffer{};
    char* const end = buffer.data() + buffer.size();
    const std::to_chars_result result =
        significant_digits ? std::to_chars(buffer.data(), end, value, std::chars_format::general,
                                           *significant_digits)
                           : std::to_chars(buffer.data(), end, value);
    return {buffer.data(), result.ptr};
}

std::string cell_text(const Cell& cell, std::optional<int> significant_digits) {
    if (const auto* text = std::get_if<std::string>(&cell)) return *text;
    if (const auto* value = std::get_if<double>(&cell)) {
        return number_text(*value, significant_digits);
    }
    if (const auto* count = std::get_if<std::int64_t>(&cell)) return std::to_string(*count);
    return {};
}

void check(const Table& table) {
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        if (table.rows[i].size() == table.columns.size()) continue;
        throw Error("table: row " + std::to_string(i) + " has " +
                    std::to_string(table.rows[i].size()) + " cells, must have " +
                    std::to_string(table.columns.size()));
    }
}

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"') out += '"';
        out += c;
    }
    out += '"';
    return out;
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

std::string markdown_line(const std::vector<MarkdownColumn>& columns, std::size_t line) {
    std::string out = "|";
    for (const MarkdownColumn& column : columns) {
        const std::string& field = column.fields[line];
        const std::size_t padding = column.width - width_of(field);
        out += ' ';
        if (column.numbers) out.append(padding, ' ');
        out += field;
        if (!column.numbers) out.append(padding, ' ');
        out += " |";
    }
    out += '\n';
    return out;
}

std::string markdown_rule(const std::vector<MarkdownColumn>& columns) {
    std::string out = "|";
    for (const MarkdownColumn& column : columns) {
        out += ' ';
        out.append(column.width - 1, '-');
        out += column.numbers ? ": |" : "- |";
    }
    out += '\n';
    return out;
}

}  // namespace

std::string to_csv(const Table& table) {
    check(table);
    std::string out;
    const auto append_line = [&](std::size_t count, const auto& field) {
        for (std::size_t i = 0; i < count; ++i) {
            if (i > 0) out += ',';
            out += csv_field(field(i));
        }
        out += '\n';
    };
    append_line(table.columns.size(), [&](std::size_t i) { return table.columns[i]; });
    for (const auto& row : table.rows) {
        append_line(row.size(), [&](std::size_t i) { return cell_text(row[i], std::nullopt); });
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

}  // namespace kilolux
