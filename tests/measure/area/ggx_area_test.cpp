// SPDX-License-Identifier: Apache-2.0
// GGX light of area lights against float64 integrals of the true lobe: the fit, the published
// errors, the limit of small lights and hard cases.
#include "kernels/shared/area/ggx_area.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "host/measure/reference/reference_brdf.h"
#include "tests/measure/area/fit/error_table.h"
#include "tests/support/paths.h"

namespace kilolux {
namespace {

// Roughnesses and cosines n.v between and at the nodes of the fit.
std::vector<RoundLobe> some_lobes() {
    std::vector<RoundLobe> lobes;
    for (const double roughness : {0.045, 0.07, 0.15, 0.3, 0.5, 0.7, 0.95, 1.0}) {
        for (const double n_dot_v : {1.0, 0.9, 0.6, 0.3, 0.1, 0.03, 1e-4}) {
            lobes.push_back({roughness * roughness, n_dot_v});
        }
    }
    return lobes;
}

AreaLobe area_lobe_of(const RoundLobe& lobe) {
    const float roughness = static_cast<float>(std::sqrt(lobe.alpha));
    const GgxLobe ggx = make_ggx_lobe(fv3(0, 0, 1), as_fv3(lobe.to_eye()), roughness);
    return make_area_lobe(ggx, ggx.alpha);
}

std::string name_of(const RoundLobe& lobe) {
    return "roughness " + std::to_string(std::sqrt(lobe.alpha)) + ", n.v " +
           std::to_string(lobe.n_dot_v);
}

TEST(GgxFit, LobesAreThoseOfTheReference) {
    SurfaceSample surface;
    surface.kind = SurfaceKind::lit;
    surface.albedo = glm::dvec3(1.0);
    surface.metallic = 1.0;
    for (const RoundLobe& lobe : some_lobes()) {
        surface.roughness = std::sqrt(lobe.alpha);
        for (int i = 0; i < 40; ++i) {
            const glm::dvec3 l = lobe.sample((i + 0.5) / 40, i * 0.618);
            if (l.z <= 0.0) continue;
            const double expected = l.z * reference_brdf(surface, lobe.to_eye(), l, Shading::pbr).x;
            EXPECT_NEAR(lobe.value(l), expected, 1e-9 * expected) << name_of(lobe);
        }
    }
}

// At the nodes the fit is nearest; between them it may be farther by the share of the polynomials.
TEST(GgxFit, NoTransformNearbyIsMuchNearerToTheLobe) {
    constexpr double kStep = 0.05, kShare = 0.01;
    for (const RoundLobe& lobe : some_lobes()) {
        const AreaLobe area = area_lobe_of(lobe);
        const double all = albedo_of(lobe, 100).all;
        const TransformedCosine fit{area.along, area.tilt, area.across};
        const double distance = lobe_distance(lobe, fit, all, 40);
        EXPECT_LT(std::sqrt(distance), lobe.n_dot_v > 0.5 ? 0.23 : 0.66) << name_of(lobe);
        for (const double factor : {1.0 - kStep, 1.0 + kStep}) {
            for (int k = 0; k < 3; ++k) {
                TransformedCosine other = fit;
                (k == 0 ? other.along : k == 1 ? other.tilt : other.across) *= factor;
                EXPECT_GT(lobe_distance(lobe, other, all, 40), distance - kShare)
                    << name_of(lobe) << ", parameter " << k << " times " << factor;
            }
        }
    }
}

TEST(GgxFit, AlbedosAreIntegralsOfTheLobe) {
    double worst = 0.0, grazing = 0.0, rise = 0.0;
    for (const RoundLobe& lobe : some_lobes()) {
        const AreaLobe area = area_lobe_of(lobe);
        const LobeAlbedo expected = albedo_of(lobe, 300);
        double& of = lobe.n_dot_v > 0.05 ? worst : grazing;
        of = std::max(of, std::abs(area.albedo / expected.all - 1.0));
        rise = std::max(rise, std::abs(area.rise - expected.rise / expected.all));
    }
    EXPECT_LT(worst, 0.02);
    EXPECT_LT(grazing, 0.025);
    EXPECT_LT(rise, 0.025);
}

// Everywhere, between the nodes, too.
TEST(GgxFit, TransformsHaveInversesAndAlbedosAreShares) {
    for (int i = 0; i <= 100; ++i) {
        for (int k = 0; k <= 400; ++k) {
            const RoundLobe lobe = table_lobe(i / 100.0, std::max(std::pow(k / 400.0, 3), 1e-4));
            const AreaLobe area = area_lobe_of(lobe);
            ASSERT_TRUE(area.along > 0.0f && area.across > 0.0f) << name_of(lobe);
            ASSERT_TRUE(area.albedo > 0.25f && area.albedo <= 1.0f) << name_of(lobe);
            ASSERT_TRUE(area.rise >= 0.0f && area.rise < 1.0f) << name_of(lobe);
        }
    }
}

// Covariances of points, evenly spread: x x^T / 3 + y y^T / 3 of a parallelogram.
TEST(GgxArea, HalfSidesOfTrianglesHaveTheirVariances) {
    const glm::dvec3 x(1.0, 0.2, -0.1), y(0.3, 0.8, 0.4);
    glm::dmat3 expected(0.0);
    constexpr int kSteps = 200;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps - i; ++j) {
            const double a = (i + 0.5) / kSteps - 1.0 / 3.0, b = (j + 0.5) / kSteps - 1.0 / 3.0;
            const glm::dvec3 at = a * x + b * y;
            expected += glm::outerProduct(at, at) / (0.5 * kSteps * (kSteps + 1));
        }
    }
    const FlatLight light =
        equal_variance_parallelogram({SHAPE_TRIANGLE, {as_fv3({0, 0, 2}), as_fv3(x), as_fv3(y)}});
    const glm::dvec3 half_x(light.half_x.x, light.half_x.y, light.half_x.z);
    const glm::dvec3 half_y(light.half_y.x, light.half_y.y, light.half_y.z);
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 row = (half_x * half_x[i] + half_y * half_y[i]) / 3.0;
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(row[k], expected[i][k], 1e-3) << i << k;
    }
}

// The numbers of a row "| a | b | mean / worst | ...".
std::vector<double> numbers_of(std::string line) {
    for (char& sign : line) sign = sign == '|' || sign == '/' ? ' ' : sign;
    std::istringstream text(line);
    return {std::istream_iterator<double>(text), {}};
}

// Every fourth row; the margins [%] are more than the rounding of what is published.
TEST(GgxArea, ErrorsAreAtMostThePublishedOnes) {
    std::ifstream file(source_root() + "/host/measure/reference/area/ggx_area_error.md");
    std::string line;
    while (std::getline(file, line) && line != std::string("## ") + kOfItself) continue;
    for (int i = 0; i < 3; ++i) std::getline(file, line);
    constexpr std::size_t kRows = kTableRoughness.size() * kTableCosines.size();
    for (std::size_t row = 0; row < kRows && std::getline(file, line); ++row) {
        if (row % 4 != 1) continue;
        const std::vector<double> published = numbers_of(line);
        ASSERT_EQ(published.size(), 2 + 2 * kTableSizes.size()) << line;
        const std::size_t r = row / kTableCosines.size(), v = row % kTableCosines.size();
        const RoundLobe lobe = table_lobe(kTableRoughness[r], kTableCosines[v]);
        for (std::size_t s = 0; s < kTableSizes.size(); ++s) {
            const AreaError now =
                cell_errors(AreaKind::rectangle, lobe, kTableSizes[s], cell_number(r, v, s))
                    .of_itself;
            const double mean = published[2 + 2 * s], worst = published[3 + 2 * s];
            EXPECT_LT(100.0 * now.mean, 0.1 + 1.05 * mean) << line << kTableSizes[s];
            EXPECT_LT(100.0 * now.worst, 0.2 + 1.05 * worst) << line << kTableSizes[s];
        }
    }
    EXPECT_TRUE(file);
}

// Means over roughness 0.1 to 1 and n.v of at least 0.25, relative to the light plus that of a
// diffuse surface.
TEST(GgxArea, EveryShapeHasTheErrorsOfRectangles) {
    for (const AreaKind kind :
         {AreaKind::rectangle, AreaKind::disk, AreaKind::sphere, AreaKind::triangle}) {
        for (const double size : {0.03, 0.3, 1.0}) {
            double mean = 0.0;
            for (unsigned i = 0; i < 6; ++i) {
                const RoundLobe lobe = table_lobe(i < 3 ? 0.25 : 0.6, 0.25 + 0.3 * (i % 3));
                mean += cell_errors(kind, lobe, size, i).of_even.mean / 6.0;
            }
            EXPECT_LT(mean, size < 0.1 ? 0.005 : 0.08) << static_cast<int>(kind) << ' ' << size;
        }
    }
}

// Lights as small as a thousandth of their distance, or of a narrow lobe's width, are points.
TEST(GgxArea, SmallLightsArePoints) {
    std::mt19937 random(5);
    for (const RoundLobe& lobe : some_lobes()) {
        if (lobe.n_dot_v < 0.02) continue;
        const double size = 1e-3 * std::min(1.0, 20.0 * lobe.alpha * lobe.n_dot_v);
        for (int i = 0; i < 12; ++i) {
            const glm::dvec3 middle = random_direction(lobe, 0.0, i, random);
            if (middle.z < 0.05) continue;
            const AreaShape shape = random_light(AreaKind::rectangle, middle, size, random);
            const double angle = area_irradiance(seen(shape), false) / middle.z;
            const glm::dvec2 light = shared_integral(lobe, shape);
            const double expected = lobe.value(middle) * angle;
            EXPECT_NEAR(light.x, expected, 1e-3 * expected) << name_of(lobe) << ' ' << i;
            EXPECT_NEAR(light.y, expected * lobe.schlick(middle), 1e-3 * expected) << name_of(lobe);
        }
    }
}

TEST(GgxArea, LightsBelowTheHorizonGiveNothing) {
    for (const RoundLobe& lobe : some_lobes()) {
        AreaShape shape;
        shape.center = {0.2, 0.1, -0.3};
        shape.half_x = {0.5, 0.0, 0.1};
        shape.half_y = {0.0, 0.5, 0.1};
        EXPECT_EQ(shared_integral(lobe, shape).x, 0.0) << name_of(lobe);
    }
}

// Lights of all sizes, distances and tilts: no NaN, no negative light, and no more than all of a
// lobe's albedo by the bound of the ratio.
TEST(GgxArea, HardCasesAreFiniteAndNotNegative) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> some(-1.0, 1.0);
    std::uniform_real_distribution<double> power(-5.0, 5.0);
    for (int i = 0; i < 60'000; ++i) {
        const double roughness = i % 3 == 0 ? 0.0 : 0.5 + 0.5 * some(random);
        const double cosine = i % 5 == 0 ? 1e-4 : i % 5 == 1 ? 1.0 : 0.5 + 0.5 * some(random);
        const RoundLobe lobe = table_lobe(roughness, cosine);
        const double distance = std::pow(10.0, power(random)), size = std::pow(10.0, power(random));
        const auto vector = [&] { return glm::dvec3(some(random), some(random), some(random)); };
        const AreaKind kinds[] = {AreaKind::rectangle, AreaKind::disk, AreaKind::triangle};
        AreaShape shape;
        shape.kind = kinds[i % 3];
        glm::dvec3 middle = glm::normalize(vector() + glm::dvec3(0, 0, 1e-3));
        if (i % 7 == 0) middle = {-lobe.to_eye().x, 0.0, lobe.n_dot_v};  // the mirror direction
        if (i % 7 == 1) middle = lobe.to_eye() * (i % 2 ? 1.0 : -1.0);
        if (i % 7 == 2) middle.z = 0.0;
        shape.center = middle * distance;
        shape.half_x = vector() * size;
        shape.half_y = i % 11 == 0 ? shape.half_x : vector() * size;
        if (i % 13 == 0) shape.half_y = glm::cross(shape.half_x, middle);
        if (i % 17 == 0) shape.center = 0.3 * shape.half_x;  // the point lies in the light
        const glm::dvec2 light = shared_integral(lobe, shape);
        ASSERT_TRUE(light.x >= 0.0 && light.y >= 0.0 && light.x < 1e30)
            << name_of(lobe) << ' ' << i;
    }
    for (const double distance : {0.5, 0.999999, 1.0, 1.000001, 2.0}) {
        AreaShape sphere;
        sphere.kind = AreaKind::sphere;
        sphere.center = {0.0, 0.3 * distance, 0.95 * distance};
        sphere.radius = 1.0;
        const double light = shared_integral({0.1, 0.5}, sphere).x;
        EXPECT_TRUE(light >= 0.0 && light < 2.0) << distance;
    }
}

// A light that grows and moves from behind the horizon across the lobe: no step of 1/20,000 of
// the way changes the light by more than 1/250 of its largest value.
TEST(GgxArea, LightIsContinuous) {
    constexpr int kSteps = 20'000;
    for (const RoundLobe& lobe : some_lobes()) {
        if (lobe.alpha < 0.02 || lobe.n_dot_v < 0.02) continue;  // their edges are steep
        for (const double size : {0.02, 1.0}) {
            double most = 0.0, step = 0.0, last = 0.0;
            for (int i = 0; i <= kSteps; ++i) {
                const double angle = 3.4 * i / kSteps - 0.1;
                const glm::dvec3 middle(-std::cos(angle), 0.1, std::sin(angle));
                AreaShape shape;
                shape.center = middle;
                shape.half_y = size * (1.0 + angle) * glm::dvec3(0.1, 1.0, 0.0);
                shape.half_x =
                    size * glm::normalize(glm::cross(shape.half_y, -middle));  // faces the point
                const double light = shared_integral(lobe, shape).x;
                if (i > 0) step = std::max(step, std::abs(light - last));
                most = std::max(most, light);
                last = light;
            }
            EXPECT_LT(step, 0.004 * most) << name_of(lobe) << ' ' << size;
        }
    }
}

// A surface and its light turned together, also with the eye straight ahead.
TEST(GgxArea, TurningTheWorldChangesNothing) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> some(-1.0, 1.0);
    const auto vector = [&] { return glm::dvec3(some(random), some(random), some(random)); };
    for (const RoundLobe& lobe : some_lobes()) {
        const AreaShape shape =
            random_light(AreaKind::rectangle, random_direction(lobe, 0.1, 2, random), 0.2, random);
        const glm::dvec3 z = glm::normalize(vector()), x = glm::normalize(glm::cross(z, vector()));
        const glm::dmat3 turn(x, glm::cross(z, x), z);
        AreaShape turned = shape;
        turned.center = turn * shape.center;
        turned.half_x = turn * shape.half_x;
        turned.half_y = turn * shape.half_y;
        const FV3 normal = as_fv3(z), eye = as_fv3(turn * lobe.to_eye());
        const AreaFrame frame = make_area_frame(normal, eye);
        GgxLobe ggx = make_ggx_lobe(normal, eye, static_cast<float>(std::sqrt(lobe.alpha)));
        const LobeLight light = area_ggx(frame, ggx, make_area_lobe(ggx, ggx.alpha),
                                         light_in_frame(frame, seen(turned)));
        const double expected = 2.0 * std::numbers::pi * shared_integral(lobe, shape).x;
        // Rounding turns the lobe of roughness 0, 0.004 wide, by 1e-7. Far from it the irradiance
        // of the transformed light is small beside its rounding.
        const double rounding = 2e-3 * expected + 1e-6;
        EXPECT_NEAR(light.light, expected, rounding) << name_of(lobe);
    }
}

}  // namespace
}  // namespace kilolux
