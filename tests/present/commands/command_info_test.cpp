// SPDX-License-Identifier: Apache-2.0
// `kilolux info` as a whole. No time is judged.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/child.h"
#include "tests/support/environment_variable.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

using Json = nlohmann::json;

TEST(Info, TellsWhatLeftOutFeaturesWouldCost) {
    const TemporaryFolder folder;
    const EnvironmentVariable cache("XDG_CACHE_HOME", folder.path().string());
    std::vector<std::string> words = {"info",  "plain",    "--json", "--resolution",
                                      "64,36", "--lights", "20"};
    const auto left_out = [&words] {
        const ChildResult result = run_kilolux(words);
        EXPECT_EQ(result.code, 0) << result.err;
        return Json::parse(result.out).at("left_out");
    };
    const auto entry_of = [](const Json& entries, const char* name) {
        for (const Json& entry : entries) {
            if (entry.at("name") == name) return entry;
        }
        ADD_FAILURE() << name;
        return Json();
    };
    const Json unmeasured = entry_of(left_out(), "spot-lights");
    EXPECT_TRUE(unmeasured.at("ms").is_null()) << unmeasured;
    EXPECT_TRUE(contains(unmeasured.at("why"), "--costs")) << unmeasured;
    words.push_back("--costs");
    const Json costs = left_out();
    const Json measured = entry_of(costs, "spot-lights");
    EXPECT_TRUE(measured.at("ms").is_number()) << measured;
    EXPECT_EQ(measured.at("measurable"), measured.at("ms") > measured.at("noise_ms")) << measured;
    EXPECT_EQ(entry_of(costs, "specular").at("bytes_per_pixel"), 4);
}

TEST(Info, SaysWhereTheTuningComesFrom) {
    const TemporaryFolder folder;
    const EnvironmentVariable cache("XDG_CACHE_HOME", folder.path().string());
    const ChildResult result = run_kilolux({"info", "plain", "--lights", "1"});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(contains(result.out, "tuning_source: shipped for ") ||
                contains(result.out, "tuning_source: built in"))
        << result.out;
}

// Whether they agree depends on what else the machine does.
TEST(Info, ComparesLimitsWithIndependentOnes) {
    const EnvironmentVariable own("KILOLUX_DEVICE_KIND", std::nullopt);
    const ChildResult result = run_kilolux({"info", "--check-limits", "--json"});
    EXPECT_TRUE(result.code == 0 || result.code == 3) << result.err;
    const Json rows = Json::parse(result.out);
    ASSERT_EQ(rows.size(), 3u);
    bool agree = true;
    for (const Json& row : rows) {
        EXPECT_GT(row.at("measured [1/s]"), 0.0) << row;
        EXPECT_GT(row.at("independent [1/s]"), 0.0) << row;
        agree = agree && row.at("result") == "agrees";
    }
    EXPECT_EQ(agree, result.code == 0) << result.err;
}

// A GPU without published peaks: its limits cannot be judged.
TEST(Info, KeepsNoLimitsThatItCouldNotJudge) {
    const TemporaryFolder folder;
    const EnvironmentVariable cache("XDG_CACHE_HOME", folder.path().string());
    const EnvironmentVariable kind("KILOLUX_DEVICE_KIND", "gpu");
    const ChildResult result = run_kilolux({"info", "--check-limits"});
    EXPECT_EQ(result.code, 1);
    EXPECT_TRUE(contains(result.err, "its published peaks are not known")) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "kilolux"));
}

// A kernel that does 64 times the work that it is counted for.
TEST(Info, KeepsNoLimitsThatDiffer) {
    const TemporaryFolder folder;
    namespace fs = std::filesystem;
    fs::copy(fs::path(source_root()) / "kernels", folder / "kernels", fs::copy_options::recursive);
    const fs::path file = folder / "kernels/limits/measure_limits.cl";
    std::string text = text_of_file(file);
    const std::string count = "i < iterations";
    const std::size_t at = text.find(count, text.find("kernel void fma_rate("));
    ASSERT_NE(at, std::string::npos);
    write_text(file, text.replace(at, count.size(), "i < 64 * iterations"));
    const EnvironmentVariable sources("KILOLUX_SOURCE_DIR", folder.path().string());
    const EnvironmentVariable cache("XDG_CACHE_HOME", (folder / "cache").string());
    const EnvironmentVariable own("KILOLUX_DEVICE_KIND", std::nullopt);
    const ChildResult result = run_kilolux({"info", "--check-limits", "--json"});
    EXPECT_EQ(result.code, 3) << result.err;
    EXPECT_TRUE(contains(result.err, "limits differ from the independent ones by more"))
        << result.err;
    const Json row = Json::parse(result.out).at(0);
    EXPECT_EQ(row.at("limit"), "fma_flops");
    EXPECT_EQ(row.at("result"), "differs");
    EXPECT_FALSE(fs::exists(folder / "cache/kilolux"));
}

TEST(Info, MeasuresLimitsAgainWhenAsked) {
    const TemporaryFolder folder;
    const EnvironmentVariable cache("XDG_CACHE_HOME", folder.path().string());
    const std::vector<std::string> words = {"info", "plain",        "--json", "--lights",
                                            "1",    "--resolution", "64,36"};
    std::vector<std::string> again = words;
    again.push_back("--measure-limits");
    const auto limits = [](const std::vector<std::string>& arguments) {
        const ChildResult result = run_kilolux(arguments);
        EXPECT_EQ(result.code, 0) << result.err;
        return Json::parse(result.out).at("limits");
    };
    const Json first = limits(words);
    EXPECT_EQ(limits(words), first) << "kept";
    const Json second = limits(again);
    EXPECT_NE(second, first);
    EXPECT_EQ(limits(words), second);
}

}  // namespace
}  // namespace kilolux
