// SPDX-License-Identifier: Apache-2.0
// The numerically hard cases and the metamorphic tests, each at several lane widths.
#include <gtest/gtest.h>
#include <algorithm>
#include <cstdlib>

#include "host/certify/hard_cases.h"
#include "host/certify/lighting_case.h"
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

// Cases of single surfaces must show each value that a surface has.
TEST(LightingCases, SurfacesHaveAllTheirValues) {
    SurfaceSample s = grey_surface({0.25, 0.5, -2.0}, {0, 0.6, 0.8});
    double next = 0.0625;
#define SET_SCALAR(has, member, decoded, plane, value) s.member = next += 0.0625;
#define SET_VECTOR(has, member, decoded, plane, value) \
    s.member = {next + 0.0625, next + 0.125, next + 0.1875}, next += 0.1875;
    SURFACE_VALUES(SET_VECTOR, SET_SCALAR)
    const LightingCase input = surface_case(std::span(&s, 1), SHADING_PBR);
    const SurfaceSample shown =
        decoded_surfaces(input, light_on_device(gpu_of_lanes(1), input)).at(0, 0);
#define EXPECT_VALUE(has, member, decoded, plane, value) EXPECT_EQ(shown.member, s.member);
    SURFACE_VALUES(EXPECT_VALUE, EXPECT_VALUE)
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
