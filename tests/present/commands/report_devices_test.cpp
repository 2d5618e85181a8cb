// SPDX-License-Identifier: Apache-2.0
// Reports that several devices measure: PoCL, asked for twice, is two equal devices.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/support/cache_sandbox.h"
#include "tests/support/child.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

using OrderedJson = nlohmann::ordered_json;

class ReportDevices : public CacheSandbox {
 protected:
    static ChildResult report(const std::string& devices, const std::vector<std::string>& more = {},
                              const std::string& pocl = "pthread pthread") {
        std::vector<std::string> words = {"/usr/bin/env", "POCL_DEVICES=" + pocl,
                                          program_file(), "report",
                                          "grid",         "--lights",
                                          "40",           "--resolution",
                                          "64,36",        "--quick",
                                          "--warm-up",    "0",
                                          "--frames",     "1",
                                          "--axes",       "gbuffer",
                                          "--json",       "--device",
                                          devices};
        words.insert(words.end(), more.begin(), more.end());
        return run_child(words);
    }
};

// A report's rows without what times decide.
OrderedJson errors_of(const OrderedJson& document) {
    OrderedJson rows = document.at("rows");
    for (OrderedJson& row : rows) {
        std::set<std::string> timed = {"pareto", "noise", "frames", "G evaluations/s"};
        for (const auto& [name, value] : row.items()) {
            if (name.ends_with(" [ms]") || name.starts_with("times default")) timed.insert(name);
        }
        for (const std::string& name : timed) row.erase(name);
    }
    return rows;
}

TEST_F(ReportDevices, MeasureTheErrorsOfOne) {
    const ChildResult one = report("0");
    ASSERT_EQ(one.code, 0) << one.err;
    const ChildResult two = report("0,1");
    ASSERT_EQ(two.code, 0) << two.err;
    const OrderedJson of_one = OrderedJson::parse(one.out), of_two = OrderedJson::parse(two.out);
    EXPECT_FALSE(of_one.at("context").contains("devices"));
    EXPECT_EQ(errors_of(of_two), errors_of(of_one));
    EXPECT_GE(of_one.at("rows").size(), 5u);
    for (const OrderedJson& row : of_two.at("rows")) EXPECT_GT(row.at("frame [ms]"), 0.0) << row;
    const OrderedJson& devices = of_two.at("context").at("devices");
    ASSERT_EQ(devices.size(), 2u);
    std::size_t settings = 0;
    for (const OrderedJson& device : devices) settings += device.at("settings").get<std::size_t>();
    EXPECT_EQ(settings, of_two.at("rows").size());
    EXPECT_TRUE(devices[0].at("times"));
    EXPECT_FALSE(devices[1].at("times")) << "times of two devices have no common unit";
}

TEST_F(ReportDevices, MayDifferWhereThatIsAllowed) {
    const std::string unlike = "pthread basic";
    const ChildResult refused = report("0,1", {}, unlike);
    EXPECT_EQ(refused.code, 2) << refused.err;
    EXPECT_TRUE(contains(refused.err, "--mixed-devices allows that")) << refused.err;
    const ChildResult budget = report("0,1", {"--mixed-devices", "--max-error", "1"}, unlike);
    EXPECT_EQ(budget.code, 2) << budget.err;
    EXPECT_TRUE(contains(budget.err, "kept for one kind of device")) << budget.err;
    const ChildResult mixed = report("all", {"--mixed-devices"}, unlike);
    ASSERT_EQ(mixed.code, 0) << mixed.err;
    const OrderedJson document = OrderedJson::parse(mixed.out);
    bool both = true;  // unless the other one has begun too late
    for (const OrderedJson& device : document.at("context").at("devices"))
        both &= device.at("settings") > 0;
    for (const OrderedJson& row : document.at("rows"))
        EXPECT_EQ(row.contains("errors by"), both) << row;
}

TEST_F(ReportDevices, HaveTheMemoryOfOne) {
    const std::vector<std::string> memory = {"--max-memory", "500M"};
    const ChildResult one = report("0", memory);
    EXPECT_EQ(one.code, 0) << one.err;
    const ChildResult two = report("0,1", memory);
    EXPECT_EQ(two.code, 1) << two.out;
    EXPECT_TRUE(contains(two.err, "; 2 renderers share 500 MiB (--max-memory)")) << two.err;
}

TEST_F(ReportDevices, AreRefusedWhereThereAreNone) {
    const ChildResult none = report("0,7");
    EXPECT_EQ(none.code, 1) << none.err;
    EXPECT_TRUE(contains(none.err, "no device '7'")) << none.err;
}

}  // namespace
}  // namespace kilolux
