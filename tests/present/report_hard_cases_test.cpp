// SPDX-License-Identifier: Apache-2.0
#include "present/commands/certify.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <sstream>

#include "host/base/error.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

TEST(ReportHardCases, RunsWhatIsAskedForAndWritesItsFiles) {
    const TemporaryFolder folder;
    HardCaseOptions options;
    options.lanes = {1, 8};
    options.only = {"27", "M2"};
    options.output = folder.path() / "report";
    options.quiet = true;
    testing::internal::CaptureStdout();
    EXPECT_TRUE(report_hard_cases(options));
    const std::string printed = testing::internal::GetCapturedStdout();
    EXPECT_EQ(printed, text_of(options.output / "hard_cases.md"));
    EXPECT_NE(printed.find("| 27 "), std::string::npos) << printed;
    EXPECT_NE(printed.find("| M2 "), std::string::npos) << printed;
    EXPECT_EQ(printed.find("| 26 "), std::string::npos) << printed;
    const auto json = nlohmann::json::parse(text_of(options.output / "hard_cases.json"));
    EXPECT_TRUE(json["passed"]);
    ASSERT_EQ(json["cases"].size(), 2u);
    EXPECT_EQ(json["cases"][0]["lanes"], nlohmann::json({1, 8}));
    EXPECT_FALSE(text_of(options.output / "hard_cases.csv").empty());
}

TEST(ReportHardCases, AnUnknownLabelIsAMistakeOfTheCommandLine) {
    HardCaseOptions options;
    options.only = {"31"};
    options.quiet = true;
    EXPECT_THROW(report_hard_cases(options), UsageError);
}

HardCaseRow row_of(std::vector<Finding> findings, bool passed) {
    return {{"1", "name", "what is tried", "what must hold", false, nullptr},
            {8},
            std::move(findings),
            {},
            passed};
}

TEST(ReportHardCases, FailuresSayWhere) {
    const std::vector<HardCaseRow> rows = {
        row_of({{"missed lights", 3, 0, 1000, "light 7, pixel 1, 2"}}, false)};
    const std::string text = to_markdown(hard_case_table(rows));
    EXPECT_NE(text.find("missed lights: 3 of 1000 FAILED at light 7, pixel 1, 2"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("| NO "), std::string::npos) << text;
    EXPECT_FALSE(hard_cases_json({}, rows)["passed"]);
}

TEST(ReportHardCases, InfiniteNumbersAreNullInJson) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const auto json = hard_cases_json({}, {row_of({{"seen", 2.5, kInfinity, 1, ""}}, true)});
    EXPECT_EQ(json["cases"][0]["findings"][0]["limit"], nullptr);
    EXPECT_EQ(json["cases"][0]["findings"][0]["worst"], 2.5);
}

}  // namespace
}  // namespace kilolux
