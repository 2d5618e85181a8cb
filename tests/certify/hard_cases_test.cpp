// SPDX-License-Identifier: Apache-2.0
// The numerically hard cases and the metamorphic tests, each at several lane widths.
#include <gtest/gtest.h>
#include <algorithm>
#include <cstdlib>

#include "host/certify/hard_cases.h"
#include "tests/support/full.h"

namespace kilolux {
namespace {

using Parameter = std::tuple<HardCase, int>;

class HardCases : public testing::TestWithParam<Parameter> {};

// All widths share one context and queue. KILOLUX_TEST_DEVICE chooses the device as --device does.
Gpu gpu_of_lanes(int lanes) {
    const char* choice = std::getenv("KILOLUX_TEST_DEVICE");
    static const Gpu gpu(choose_device(choice != nullptr ? choice : ""));
    return gpu.with_lanes(lanes);
}

TEST_P(HardCases, HoldsItsThreshold) {
    const auto& [hard_case, lanes] = GetParam();
    Findings findings;
    hard_case.run(gpu_of_lanes(lanes), findings);
    for (const Finding& finding : findings.all()) {
        EXPECT_TRUE(finding.passed()) << hard_case.topic << ": " << finding_text(finding);
    }
    EXPECT_TRUE(findings.passed()) << "nothing was tried";
}

// "Case7_off_centre_Lanes8"
std::string name_of(const testing::TestParamInfo<Parameter>& info) {
    const auto& [hard_case, lanes] = info.param;
    std::string name = "Case" + std::string(hard_case.label) + "_" + std::string(hard_case.name);
    std::replace(name.begin(), name.end(), '-', '_');
    return name + "_Lanes" + std::to_string(lanes);
}

INSTANTIATE_TEST_SUITE_P(All, HardCases,
                         testing::Combine(testing::ValuesIn(hard_cases()),
                                          testing::ValuesIn(lane_widths())),
                         name_of);

}  // namespace

// The text of a parameter in gtest's messages.
void PrintTo(const HardCase& hard_case, std::ostream* out) {
    *out << "case " << hard_case.label << ", " << hard_case.name;
}

}  // namespace kilolux
