// SPDX-License-Identifier: Apache-2.0
// The numerically hard cases and the metamorphic tests, each at every lane width.
#include <gtest/gtest.h>

#include <cctype>
#include <cstdlib>

#include "host/certify/hard_case.h"

namespace kilolux {
namespace {

using Parameter = std::tuple<HardCase, int>;

class HardCases : public testing::TestWithParam<Parameter> {};

// All widths share one context and queue. KILOLUX_TEST_DEVICE chooses the device as --device does.
Gpu test_gpu(int lanes) {
    const char* choice = std::getenv("KILOLUX_TEST_DEVICE");
    static const Gpu gpu(choose_device(choice != nullptr ? choice : ""));
    return gpu.with_lanes(lanes);
}

TEST_P(HardCases, HoldsItsThreshold) {
    const auto& [hard_case, lanes] = GetParam();
    Findings findings;
    hard_case.run(test_gpu(lanes), findings);
    for (const Finding& finding : findings.all()) {
        EXPECT_TRUE(finding.passed()) << hard_case.tried << ": " << finding_text(finding);
    }
    EXPECT_TRUE(findings.passed()) << "nothing was tried";
}

std::string name_of(const testing::TestParamInfo<Parameter>& info) {
    const auto& [hard_case, lanes] = info.param;
    std::string name = "Case" + hard_case.label + "_";
    bool upper = true;
    for (const char c : hard_case.name) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) {
            upper = true;
            continue;
        }
        name += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        upper = false;
    }
    return name + "_Lanes" + std::to_string(lanes);
}

INSTANTIATE_TEST_SUITE_P(All, HardCases,
                         testing::Combine(testing::ValuesIn(hard_cases()),
                                          testing::Values(1, 2, 4, 8, 16)),
                         name_of);

}  // namespace

// What gtest prints of a parameter.
void PrintTo(const HardCase& hard_case, std::ostream* out) {
    *out << "case " << hard_case.label << ", " << hard_case.name;
}

}  // namespace kilolux
