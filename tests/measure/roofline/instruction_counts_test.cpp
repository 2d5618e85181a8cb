// SPDX-License-Identifier: Apache-2.0
// The instruction counts of the roofline, against evaluate() itself compiled with a type that
// counts its operations.
#include "host/stages/shading/instruction_counts.h"

#include <gtest/gtest.h>

#include "tests/measure/roofline/counting_lanes.h"

#define SHADING SHADING_LAMBERT
#define HAS_SPOT_LIGHTS 0
#define HAS_METALLIC 0
#define COUNTED lambert
#include "tests/measure/roofline/counted_evaluate.h"
#undef HAS_SPOT_LIGHTS
#define HAS_SPOT_LIGHTS 1
#define COUNTED lambert_spots
#include "tests/measure/roofline/counted_evaluate.h"
#undef SHADING
#define SHADING SHADING_BLINN_PHONG
#undef HAS_SPOT_LIGHTS
#define HAS_SPOT_LIGHTS 0
#define COUNTED blinn_phong
#include "tests/measure/roofline/counted_evaluate.h"
#undef SHADING
#define SHADING SHADING_PBR
#define COUNTED pbr
#include "tests/measure/roofline/counted_evaluate.h"
#undef HAS_METALLIC
#define HAS_METALLIC 1
#define COUNTED pbr_metallic
#include "tests/measure/roofline/counted_evaluate.h"
#undef HAS_SPOT_LIGHTS
#define HAS_SPOT_LIGHTS 1
#define COUNTED pbr_metallic_spots
#include "tests/measure/roofline/counted_evaluate.h"

namespace {

using kilolux::InstructionCounts;

constexpr float kInRange = 0.5f, kOutOfRange = 2.0f;

struct Case {
    const char* name;
    InstructionCounts (*count)(float distance);
    InstructionCounts (*count_directional)();
    int shading;
    bool metallic, spots;

    kilolux::KernelFeatures features() const {
        kilolux::KernelFeatures features;
        features.shading = shading;
        features.metallic = metallic;
        features.spot_lights = spots;
        return features;
    }
};

const Case kCases[] = {
    {"lambert", lambert::count_evaluation, lambert::count_directional, SHADING_LAMBERT, false,
     false},
    {"lambert, spots", lambert_spots::count_evaluation, lambert_spots::count_directional,
     SHADING_LAMBERT, false, true},
    {"blinn-phong", blinn_phong::count_evaluation, blinn_phong::count_directional,
     SHADING_BLINN_PHONG, false, false},
    {"pbr", pbr::count_evaluation, pbr::count_directional, SHADING_PBR, false, false},
    {"pbr, metallic", pbr_metallic::count_evaluation, pbr_metallic::count_directional, SHADING_PBR,
     true, false},
    {"pbr, metallic, spots", pbr_metallic_spots::count_evaluation,
     pbr_metallic_spots::count_directional, SHADING_PBR, true, true},
};

void expect_equal(const InstructionCounts& counted, const InstructionCounts& model) {
    EXPECT_EQ(counted.total, model.total);
    EXPECT_EQ(counted.rsqrts, model.rsqrts);
    EXPECT_EQ(counted.sqrts, model.sqrts);
    EXPECT_EQ(counted.divisions, model.divisions);
}

TEST(InstructionCountsTest, OfLightsInRangeAreThoseOfEvaluate) {
    for (const Case& c : kCases) {
        SCOPED_TRACE(c.name);
        expect_equal(c.count(kInRange), kilolux::evaluation_instructions(c.features()));
    }
}

TEST(InstructionCountsTest, OfDirectionalLightsAreThoseOfEvaluateDirectional) {
    for (const Case& c : kCases) {
        SCOPED_TRACE(c.name);
        expect_equal(c.count_directional(), kilolux::directional_instructions(c.features()));
    }
}

TEST(InstructionCountsTest, OfLightsOutOfRangeEndWithTheRangeTest) {
    for (const Case& c : kCases) {
        SCOPED_TRACE(c.name);
        const auto features = c.features();
        EXPECT_EQ(kilolux::leaves_early(features), c.shading != SHADING_LAMBERT);
        expect_equal(c.count(kOutOfRange), kilolux::leaves_early(features)
                                               ? kilolux::range_test_instructions()
                                               : kilolux::evaluation_instructions(features));
    }
}

}  // namespace
