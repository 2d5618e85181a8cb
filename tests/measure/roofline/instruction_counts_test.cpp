// SPDX-License-Identifier: Apache-2.0
// The instruction counts of the roofline, against evaluate() itself compiled with a type that
// counts its operations.
#include "host/stages/shading/instruction_counts.h"

#include <gtest/gtest.h>

#include "tests/measure/roofline/counting_lanes.h"

#define HAS_METALLIC 0
#define HAS_SPECULAR 0
#define HAS_CLEARCOAT 0
#define HAS_COAT_NORMAL 0
#define HAS_SHEEN 0
#define HAS_SPOT_LIGHTS 0
#define SHADING SHADING_LAMBERT
#define COUNTED lambert
#include "tests/measure/roofline/counted_evaluate.h"
#undef HAS_SPOT_LIGHTS
#define HAS_SPOT_LIGHTS 1
#define COUNTED lambert_spots
#include "tests/measure/roofline/counted_evaluate.h"
#undef SHADING
#define SHADING SHADING_BLINN_PHONG
#define COUNTED blinn_phong_spots
#include "tests/measure/roofline/counted_evaluate.h"
#undef HAS_SPOT_LIGHTS
#define HAS_SPOT_LIGHTS 0
#define COUNTED blinn_phong
#include "tests/measure/roofline/counted_evaluate.h"
#undef SHADING
#define SHADING SHADING_PBR
#define COUNTED pbr
#include "tests/measure/roofline/counted_evaluate.h"
#undef HAS_SPOT_LIGHTS
#define HAS_SPOT_LIGHTS 1
#define COUNTED pbr_spots
#include "tests/measure/roofline/counted_evaluate.h"
#undef HAS_METALLIC
#define HAS_METALLIC 1
#define COUNTED pbr_metallic_spots
#include "tests/measure/roofline/counted_evaluate.h"
#undef HAS_SPOT_LIGHTS
#define HAS_SPOT_LIGHTS 0
#define COUNTED pbr_metallic
#include "tests/measure/roofline/counted_evaluate.h"
#undef HAS_SPECULAR
#define HAS_SPECULAR 1
#define COUNTED pbr_metallic_specular
#include "tests/measure/roofline/counted_evaluate.h"
#undef HAS_METALLIC
#define HAS_METALLIC 0
#define COUNTED pbr_specular
#include "tests/measure/roofline/counted_evaluate.h"
#undef HAS_SPOT_LIGHTS
#define HAS_SPOT_LIGHTS 1
#define COUNTED pbr_specular_spots
#include "tests/measure/roofline/counted_evaluate.h"
#undef HAS_CLEARCOAT
#define HAS_CLEARCOAT 1
#define COUNTED pbr_specular_coat_spots
#include "tests/measure/roofline/counted_evaluate.h"
#undef HAS_COAT_NORMAL
#define HAS_COAT_NORMAL 1
#define COUNTED pbr_specular_coat_normal_spots
#include "tests/measure/roofline/counted_evaluate.h"
#undef HAS_SHEEN
#define HAS_SHEEN 1
#undef HAS_SPECULAR
#define HAS_SPECULAR 0
#define COUNTED pbr_coat_normal_sheen_spots
#include "tests/measure/roofline/counted_evaluate.h"
#undef HAS_SPECULAR
#define HAS_SPECULAR 1
#define COUNTED pbr_every_lobe_spots
#include "tests/measure/roofline/counted_evaluate.h"
#undef HAS_ANISOTROPY
#define HAS_ANISOTROPY 1
#define COUNTED pbr_every_stretched_lobe_spots
#include "tests/measure/roofline/counted_evaluate.h"

namespace {

using kilolux::InstructionCounts;

constexpr float kInRange = 0.5f, kOutOfRange = 2.0f;

struct Case {
    const char* name;
    InstructionCounts (*count)(float distance);
    InstructionCounts (*count_directional)();
    struct {
        int shading;
        bool metallic = false, specular = false, spots = false, clearcoat = false, sheen = false;
        bool coat_normals = false, anisotropy = false;
    } of;

    kilolux::KernelFeatures features() const {
        kilolux::KernelFeatures features;
        features.shading = of.shading;
        features.metallic = of.metallic;
        features.specular = of.specular;
        features.clearcoat = of.clearcoat;
        features.coat_normals = of.coat_normals;
        features.sheen = of.sheen;
        features.anisotropy = of.anisotropy;
        features.spot_lights = of.spots;
        return features;
    }
};

#define CASE(name, ...)                                                         \
    {                                                                           \
#name, name::count_evaluation, name::count_directional, { __VA_ARGS__ } \
    }
const Case kCases[] = {
    CASE(lambert, .shading = SHADING_LAMBERT),
    CASE(lambert_spots, .shading = SHADING_LAMBERT, .spots = true),
    CASE(blinn_phong, .shading = SHADING_BLINN_PHONG),
    CASE(blinn_phong_spots, .shading = SHADING_BLINN_PHONG, .spots = true),
    CASE(pbr, .shading = SHADING_PBR),
    CASE(pbr_spots, .shading = SHADING_PBR, .spots = true),
    CASE(pbr_metallic, .shading = SHADING_PBR, .metallic = true),
    CASE(pbr_metallic_spots, .shading = SHADING_PBR, .metallic = true, .spots = true),
    CASE(pbr_specular, .shading = SHADING_PBR, .specular = true),
    CASE(pbr_specular_spots, .shading = SHADING_PBR, .specular = true, .spots = true),
    CASE(pbr_specular_coat_spots, .shading = SHADING_PBR, .specular = true, .spots = true,
         .clearcoat = true),
    CASE(pbr_specular_coat_normal_spots, .shading = SHADING_PBR, .specular = true, .spots = true,
         .clearcoat = true, .coat_normals = true),
    CASE(pbr_coat_normal_sheen_spots, .shading = SHADING_PBR, .spots = true, .clearcoat = true,
         .sheen = true, .coat_normals = true),
    CASE(pbr_every_lobe_spots, .shading = SHADING_PBR, .specular = true, .spots = true,
         .clearcoat = true, .sheen = true, .coat_normals = true),
    CASE(pbr_every_stretched_lobe_spots, .shading = SHADING_PBR, .specular = true, .spots = true,
         .clearcoat = true, .sheen = true, .coat_normals = true, .anisotropy = true),
    CASE(pbr_metallic_specular, .shading = SHADING_PBR, .metallic = true, .specular = true),
};
#undef CASE

void expect_equal(const InstructionCounts& counted, const InstructionCounts& model) {
    EXPECT_EQ(counted.total, model.total);
    EXPECT_EQ(counted.rsqrts, model.rsqrts);
    EXPECT_EQ(counted.sqrts, model.sqrts);
    EXPECT_EQ(counted.divisions, model.divisions);
}

TEST(InstructionCountsTest, LobesTakeNoneWhereASurfaceHasNothingOfThem) {
    kilolux::KernelFeatures features;
    features.shading = SHADING_PBR;
    features.specular = features.spot_lights = true;
    const auto bare = pbr_every_lobe_spots::some_point(0.0f);
    expect_equal(pbr_every_lobe_spots::count_evaluation_of(bare, kInRange),
                 kilolux::evaluation_instructions(features));
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
        EXPECT_EQ(kilolux::leaves_early(features), c.of.shading != SHADING_LAMBERT);
        expect_equal(c.count(kOutOfRange), kilolux::leaves_early(features)
                                               ? kilolux::range_test_instructions()
                                               : kilolux::evaluation_instructions(features));
    }
}

}  // namespace
