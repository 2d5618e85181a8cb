// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/columns.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "host/base/error.h"
#include "host/measure/report/tables.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

const std::vector<std::string> kStages = {"bin_pixels", "cast_shadows", "shade"};

// A row with another text in each column, numbers as whole ones.
TextTable one_row() {
    const std::map<std::string, std::string> texts = {
        {"setting", "gbuffer half"}, {"axis", "gbuffer"},     {"options", "--gbuffer half"},
        {"scaled", "by pixels"},     {"error size", "12x34"}, {"estimate", "standard"}};
    TextTable out{{}, std::vector<std::vector<std::string>>(1)};
    for (const ReportColumn& column : report_columns(kStages)) {
        const auto text = texts.find(column.name);
        out.rows[0].push_back(text != texts.end() ? text->second
                                                  : std::to_string(100 + out.columns.size()));
        out.columns.push_back(column.name);
    }
    return out;
}

// Each column that is read back sets what it shows, and nothing that another one shows.
TEST(ReportColumns, ReadBackWhatTheyShow) {
    const TextTable texts = one_row();
    const std::vector<ReportRow> rows = report_rows(texts);
    EXPECT_EQ(stage_names(rows), kStages);
    const Table given = table_of(texts);
    std::set<std::string> lost;
    std::size_t place = 0;
    for (const ReportColumn& column : report_columns(kStages)) {
        const Cell &before = given.rows[0][place], after = column.cell(rows[0]);
        ++place;
        if (!column.take) {
            lost.insert(column.name);
        } else if (const auto* number = std::get_if<std::int64_t>(&before)) {
            const auto* read = std::get_if<double>(&after);
            ASSERT_NE(read, nullptr) << column.name;
            EXPECT_DOUBLE_EQ(*read, static_cast<double>(*number)) << column.name;
        } else {
            EXPECT_EQ(after, before) << column.name;
        }
    }
    // No table of a merged report shows them, or it computes them anew.
    EXPECT_EQ(lost, (std::set<std::string>{"pareto", "frames", "k*/k", "missed lights", "errors by",
                                           "R1 worst pixel", "R1 worst rel pixel", "R2 worst pixel",
                                           "R2 worst rel pixel", "R3 worst pixel",
                                           "R3 worst rel pixel"}));
}

// Shadows are columns of the summary only where a row casts them, which its stages tell.
TEST(ReportColumns, KnowShadowsByTheirStage) {
    TextTable texts = one_row();
    const auto empty = [&](const char* column) {
        const auto found = std::ranges::find(texts.columns, column);
        texts.rows[0][static_cast<std::size_t>(found - texts.columns.begin())] = "";
    };
    EXPECT_EQ(report_rows(texts)[0].setting.settings.shadows, Shadows::sampled);
    empty("shadow rays");
    EXPECT_EQ(report_rows(texts)[0].setting.settings.shadows, Shadows::exact);
    empty("cast_shadows [ms]");
    EXPECT_EQ(report_rows(texts)[0].setting.settings.shadows, Shadows::off);
}

TEST(ReportColumns, NameTheLineOfATextThatIsNoValue) {
    TextTable texts = one_row();
    texts.rows.push_back(texts.rows[0]);
    const auto set = [&](const char* column, const char* text) {
        const auto found = std::ranges::find(texts.columns, column);
        std::vector<std::string> row = texts.rows[0];
        row[static_cast<std::size_t>(found - texts.columns.begin())] = text;
        texts.rows[1] = row;
        return message_of<Error>([&] { report_rows(texts); });
    };
    EXPECT_EQ(set("R2 rmse", "x"), "line 3: R2 rmse is 'x', must be a number");
    EXPECT_EQ(set("axis", "x"), "line 3: axis is 'x', which is no axis");
    EXPECT_EQ(set("error size", "12"), "line 3: error size is '12', must be a size");
}

}  // namespace
}  // namespace kilolux
