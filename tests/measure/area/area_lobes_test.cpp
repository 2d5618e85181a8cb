// SPDX-License-Identifier: Apache-2.0
// The light of area lights on surfaces of every lobe, against float64 integrals of the reference's
// BRDF and against point lights.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "host/measure/reference/reference_brdf.h"
#include "tests/measure/area/fit/area_cases.h"

// The shading of glTF's model with every lobe, in a namespace of its own: other programs' files
// compile the same functions with other switches.
#define SHADING SHADING_PBR
#define HAS_MATERIAL 1
#define HAS_METALLIC 1
#define HAS_SPECULAR 1
#define HAS_CLEARCOAT 1
#define HAS_COAT_NORMAL 1
#define HAS_SHEEN 1
#define HAS_ANISOTROPY 1
#define HAS_SPOT_LIGHTS 0
#define HAS_AREA_LIGHTS 1
namespace every_lobe {
using namespace kilolux;
}
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#define kilolux every_lobe
#include "kernels/shared/area/area_lobes.h"
#include "kernels/shared/evaluate.h"
#undef kilolux
#pragma GCC diagnostic pop

namespace every_lobe {
namespace {

FV3 as_fv3(const glm::dvec3& v) {
    return fv3(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
}

SurfaceSample plain_surface(double roughness, double metallic) {
    SurfaceSample s;
    s.kind = SurfaceKind::lit;
    s.albedo = glm::dvec3(0.5);
    s.roughness = roughness;
    s.metallic = metallic;
    s.specular = glm::dvec3(0.04);
    s.coat_normal = s.normal;
    s.tangent = {1.0, 0.0, 0.0};
    return s;
}

// With the eye straight towards `to_eye` from far away.
every_lobe::Surface shared_surface(const SurfaceSample& s, const glm::dvec3& to_eye) {
    every_lobe::Surface out = default_surface();
    out.position = as_fv3(-1e3 * to_eye);
    out.normal = as_fv3(s.normal);
    const auto number = [](double x) { return static_cast<float>(x); };
    out.albedo = as_fv3(s.albedo);
    out.roughness = number(s.roughness);
    out.metallic = number(s.metallic);
    out.specular = as_fv3(s.specular);
    out.specular_f90 = number(s.specular_f90);
    out.coat = number(s.coat);
    out.coat_roughness = number(s.coat_roughness);
    out.coat_normal = as_fv3(s.coat_normal);
    out.sheen = as_fv3(s.sheen);
    out.sheen_roughness = number(s.sheen_roughness);
    out.tangent = as_fv3(s.tangent);
    out.anisotropy = number(s.anisotropy);
    return out;
}

LightShape shape_row(const AreaShape& shape) {
    const FV3 x = as_fv3(shape.half_x), y = as_fv3(shape.half_y);
    const FV3 area = cross3(x, y);
    return {{x.x, x.y, x.z, float{SHAPE_RECTANGLE}},
            {y.x, y.y, y.z, 0.25f / lane_sqrt(dot3(area, area))}};
}

constexpr float4 kWhite{1.0f, 1.0f, 1.0f, 1.0f};

// Radiance by luminance 1.
double shared_radiance(const SurfaceSample& s, const glm::dvec3& to_eye, const AreaShape& shape) {
    const every_lobe::Surface surface = shared_surface(s, to_eye);
    const every_lobe::ShadingPoint p = make_shading_point(surface, false);
    LightShape row = shape_row(shape);
    row.half_y.w = 1.0f;
    const every_lobe::LightSum sum =
        add_area_light(zero_sum(), p, row, as_fv3(shape.center), 1.0f, kWhite);
    return reflected_radiance(surface, p, sum).y;
}

double true_radiance(const SurfaceSample& s, const glm::dvec3& to_eye, const AreaShape& shape) {
    const glm::dvec3 mirror(-to_eye.x, -to_eye.y, to_eye.z);
    const double narrow = std::min({s.roughness, s.coat > 0.0 ? s.coat_roughness : 1.0});
    return PeakedIntegral(shape, mirror,
                          std::max(0.5 * narrow * narrow, 2e-3))([&](const glm::dvec3& l) {
               return glm::dvec2(reference_reflection(s, to_eye, l, Shading::pbr).y, 0.0);
           })
        .x;
}

struct Errors {
    double mean = 0.0, worst = 0.0;
};

// Of lights around the mirror direction and elsewhere, by n.v from 0.2 to 1.
Errors errors_of(const SurfaceSample& s, double size) {
    constexpr int kLights = 60;
    std::mt19937 random(3);
    Errors errors;
    for (int i = 0; i < kLights; ++i) {
        const double cosine = 0.2 + 0.8 * ((i * 7) % 10) / 9.0, around = 2.4 * i;
        const double sine = std::sqrt(1.0 - cosine * cosine);
        const glm::dvec3 to_eye(sine * std::cos(around), sine * std::sin(around), cosine);
        const RoundLobe lobe{0.2, cosine};
        glm::dvec3 middle = random_direction(lobe, size, i, random);  // in the plane x, z
        middle = {middle.x * std::cos(around) - middle.y * std::sin(around),
                  middle.x * std::sin(around) + middle.y * std::cos(around), middle.z};
        const AreaShape shape = random_light(AreaKind::rectangle, middle, size, random);
        const double expected = true_radiance(s, to_eye, shape);
        const double error = std::abs(shared_radiance(s, to_eye, shape) - expected) / expected;
        errors.mean += error / kLights;
        errors.worst = std::max(errors.worst, error);
    }
    return errors;
}

struct Case {
    const char* name;
    SurfaceSample surface;
    std::array<double, 3> mean;  // bounds of the mean errors at sizes 0.05, 0.4 and 1.5
};

std::vector<Case> cases() {
    Case diffuse{"diffuse", plain_surface(1.0, 0.0), {0.001, 0.005, 0.01}};
    Case glossy{"dielectric, roughness 0.4", plain_surface(0.4, 0.0), {0.006, 0.025, 0.035}};
    Case metal{"metal, roughness 0.4", plain_surface(0.4, 1.0), {0.008, 0.045, 0.09}};
    Case coat = diffuse, sheen = diffuse, stretched = metal;
    coat.name = "coat of its own normal, roughness 0.3";
    coat.mean = {0.01, 0.03, 0.03};
    sheen.mean = {0.003, 0.02, 0.09};
    stretched.mean = {0.03, 0.2, 0.33};
    coat.surface.coat = 1.0;
    coat.surface.coat_roughness = 0.3;
    coat.surface.coat_normal = glm::normalize(glm::dvec3(0.1, -0.1, 1.0));
    sheen.name = "sheen, roughness 0.5";
    sheen.surface.sheen = glm::dvec3(0.8);
    sheen.surface.sheen_roughness = 0.5;
    stretched.name = "metal, roughness 0.4, anisotropy 0.6";
    stretched.surface.anisotropy = 0.6;
    return {diffuse, glossy, metal, coat, sheen, stretched};
}

TEST(AreaLobes, MeanErrorsAreBelowTheStatedOnes) {
    const double sizes[] = {0.05, 0.4, 1.5};
    for (const Case& c : cases()) {
        for (int i = 0; i < 3; ++i) {
            const Errors errors = errors_of(c.surface, sizes[i]);
            EXPECT_LT(errors.mean, c.mean[i])
                << c.name << ", size " << sizes[i] << ", largest " << errors.worst;
        }
    }
}

// The sums of a light of size 1e-3 of its distance are those of a point of its intensity.
TEST(AreaLobes, SmallLightsArePoints) {
    std::mt19937 random(4);
    for (const Case& c : cases()) {
        for (int i = 0; i < 30; ++i) {
            const double cosine = 0.3 + 0.023 * i;
            const glm::dvec3 to_eye(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
            const glm::dvec3 middle = random_direction({0.2, cosine}, 0.0, i, random);
            if (middle.z < 0.1) continue;
            AreaShape shape = random_light(AreaKind::rectangle, middle, 1e-3, random);
            shape.half_x = glm::normalize(glm::cross(middle, {0.1, 0.2, 0.3})) * 5e-4;
            shape.half_y = glm::cross(shape.half_x, middle);  // faces the point
            const every_lobe::Surface surface = shared_surface(c.surface, to_eye);
            const every_lobe::ShadingPoint p = make_shading_point(surface, false);
            IncidentLight from{as_fv3(middle), 1.0f, static_cast<float>(middle.z), 1.0f,
                               static_cast<float>(middle.z)};
            const every_lobe::LightSum point = add_lobes(zero_sum(), p, from, kWhite);
            const every_lobe::LightSum area =
                add_area_light(zero_sum(), p, shape_row(shape), as_fv3(middle), 1.0f, kWhite);
            EXPECT_NEAR(area.diffuse.y, point.diffuse.y, 1e-3 * point.diffuse.y) << c.name << i;
            EXPECT_NEAR(area.specular.y, point.specular.y, 1e-3 * point.specular.y) << c.name << i;
        }
    }
}

// Either side of a light of two sides is the light of one side that faces the point.
TEST(AreaLobes, LightsOfTwoSidesShineToBoth) {
    const SurfaceSample s = plain_surface(0.4, 0.0);
    const glm::dvec3 to_eye = glm::normalize(glm::dvec3(1.0, 0.0, 1.0));
    const every_lobe::ShadingPoint p = make_shading_point(shared_surface(s, to_eye), false);
    AreaShape shape;
    shape.half_x = {-0.5, 0.0, 0.0};
    shape.half_y = {0.0, 0.5, 0.2};
    const FV3 v = fv3(-0.2f, 0.1f, 1.0f);
    LightShape row = shape_row(shape);
    const float4 color{2.0f, 1.0f, 3.0f, 1.0f};
    const auto light = [&] { return add_area_light(zero_sum(), p, row, v, 0.5f, color); };
    const every_lobe::LightSum facing = light();
    EXPECT_GT(facing.specular.x, 0.0f);
    EXPECT_FLOAT_EQ(facing.diffuse.z, 1.5f * facing.diffuse.x);
    row.half_x.w = -row.half_x.w;
    EXPECT_EQ(light().specular.x, facing.specular.x);
    row.half_x = {-row.half_x.x, 0.0f, 0.0f, row.half_x.w};
    EXPECT_FLOAT_EQ(light().specular.x, facing.specular.x);
    EXPECT_FLOAT_EQ(light().diffuse.x, facing.diffuse.x);
    row.half_x.w = -row.half_x.w;
    EXPECT_EQ(light().specular.x, 0.0f);
    EXPECT_EQ(light().diffuse.x, 0.0f);
}

}  // namespace
}  // namespace every_lobe
