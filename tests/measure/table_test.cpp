// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "host/base/error.h"

namespace kilolux {
namespace {

Table sample_table() {
    return {{"setting", "shade [ms]", "lights"},
            {{"plain", 1.0 / 3.0, std::int64_t{5000}},
             {"a|b, \"c\"\nd", 1e-9, std::monostate{}},
             {"", INFINITY, std::int64_t{-1}}}};
}

TEST(Table, Csv) {
    EXPECT_EQ(to_csv(sample_table()),
              "setting,shade [ms],lights\n"
              "plain,0.3333333333333333,5000\n"
              "\"a|b, \"\"c\"\"\nd\",1e-09,\n"
              ",inf,-1\n");
}

TEST(Table, CsvNumbersReadBackTheSame) {
    for (const double v : {0.1, 1.0 / 3.0, 1e300, 5e-324, 123456789.123456789, -0.0}) {
        const std::string csv = to_csv({{"v"}, {{v}}});
        EXPECT_EQ(std::strtod(csv.c_str() + 2, nullptr), v) << csv;
    }
    EXPECT_EQ(to_csv({{"v"}, {{std::nan("")}}}), "v\nnan\n");
}

TEST(Table, Markdown) {
    EXPECT_EQ(to_markdown(sample_table()),
              "| setting     | shade [ms] | lights |\n"
              "| ----------- | ---------: | -----: |\n"
              "| plain       |     0.3333 |   5000 |\n"
              "| a\\|b, \"c\" d |      1e-09 |        |\n"
              "|             |        inf |     -1 |\n");
}

TEST(Table, MarkdownCountsCharactersNotBytes) {
    EXPECT_EQ(to_markdown({{"größe"}, {{"µ"}}}), "| größe |\n| ----- |\n| µ     |\n");
}

TEST(Table, RowsMustFit) {
    EXPECT_THROW(to_csv({{"a", "b"}, {{1.0}}}), Error);
    EXPECT_THROW(to_markdown({{"a"}, {{1.0, 2.0}}}), Error);
    EXPECT_EQ(to_csv({{"a", "b"}, {}}), "a,b\n");
}

TEST(Table, CsvLinesMayEndInCrLf) {
    const TextTable texts = parse_csv("a,b\r\n1,\"x\r\ny\"\r\n2,\r\n");
    EXPECT_EQ(texts.columns, (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(texts.rows, (std::vector<std::vector<std::string>>{{"1", "x\r\ny"}, {"2", ""}}));
}

TEST(Table, CsvComesBack) {
    const TextTable texts = parse_csv(to_csv(sample_table()));
    EXPECT_EQ(texts.columns, sample_table().columns);
    ASSERT_EQ(texts.rows.size(), 3u);
    EXPECT_EQ(texts.rows[1], (std::vector<std::string>{"a|b, \"c\"\nd", "1e-09", ""}));
    EXPECT_EQ(to_csv(table_of(texts)), to_csv(sample_table()));
    EXPECT_EQ(to_markdown(table_of(texts)), to_markdown(sample_table()));
    EXPECT_TRUE(parse_csv("").columns.empty());
    EXPECT_THROW(parse_csv("a,b\n1\n"), Error);
}

}  // namespace
}  // namespace kilolux
