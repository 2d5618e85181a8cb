// SPDX-License-Identifier: Apache-2.0
// Illuminance of points, in float64 and by the kernels, against closed forms and sums of the test's
// own.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "host/measure/photometry/exact_illuminance.h"
#include "host/measure/photometry/point_lighting.h"
#include "host/scene/lights/photometry/photometry_file.h"
#include "tests/support/ies_text.h"

namespace kilolux {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;
// What the kernels are promised to keep; float64's sums are within 1e-12.
constexpr double kKernelError = 1e-5;

SceneLight point_light(glm::dvec3 position, float candela) {
    SceneLight light;
    light.position = position;
    light.intensity = glm::vec3(candela);
    return light;
}

Scene scene_of(std::vector<SceneLight> lights) {
    Scene scene;
    scene.lights = std::move(lights);
    return scene;
}

std::vector<double> by_kernels(const Scene& scene, const std::vector<MeasuringPoint>& points) {
    return PointLighting(scene, RenderSettings()).illuminance(points, order_in_groups(points));
}

// Both ways give `expected` [lx] at each point.
void expect_lux(const Scene& scene, const std::vector<MeasuringPoint>& points,
                const std::vector<double>& expected, double exact_error = 1e-12) {
    const ExactLighting exact(scene);
    const std::vector<double> kernels = by_kernels(scene, points);
    const double most = *std::max_element(expected.begin(), expected.end());
    ASSERT_GT(most, 0.0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(exact.at(points[i]).lux, expected[i], exact_error * most) << i;
        EXPECT_NEAR(kernels[i], expected[i], kKernelError * most) << i;
    }
}

TEST(Photometry, APointOverAPlane) {
    // E = I cos^3 / h^2.
    const double h = 3.0;
    std::vector<MeasuringPoint> points;
    std::vector<double> expected;
    for (const double r : {0.0, 0.5, 2.0, 7.0}) {
        points.push_back({{10.0 + r, 1.0, -4.0}, {0, 1, 0}});
        expected.push_back(250.0 * std::pow(h / std::hypot(h, r), 3.0) / (h * h));
    }
    expect_lux(scene_of({point_light({10.0, 1.0 + h, -4.0}, 250.0f)}), points, expected);
}

TEST(Photometry, ATiltedPlane) {
    // The light is 2 m above; a plane that is tilted by t has cos t of it, none from behind.
    std::vector<MeasuringPoint> points;
    std::vector<double> expected;
    for (const double t : {0.0, 30.0, 60.0, 89.0, 91.0, 180.0}) {
        points.push_back({{0, 0, 0}, {std::sin(t * kDegree), std::cos(t * kDegree), 0}});
        expected.push_back(std::max(std::cos(t * kDegree), 0.0) * 100.0 / 4.0);
    }
    expect_lux(scene_of({point_light({0, 2, 0}, 100.0f)}), points, expected);
}

TEST(Photometry, ColoursHaveTheirLuminance) {
    SceneLight light = point_light({0, 2, 0}, 1.0f);
    light.intensity = {100.0f, 40.0f, 20.0f};
    const double candela = 0.2126 * 100.0 + 0.7152 * 40.0 + 0.0722 * 20.0;
    expect_lux(scene_of({light}), {{}}, {candela / 4.0});
}

TEST(Photometry, ASpotsCone) {
    // Full to 20 degrees, then the square of a ramp of cosines to 40 (KHR_lights_punctual).
    SceneLight spot = point_light({0, 4, 0}, 500.0f);
    spot.type = LightType::spot;
    spot.direction = {0, -1, 0};
    spot.inner_cone = static_cast<float>(20.0 * kDegree);
    spot.outer_cone = static_cast<float>(40.0 * kDegree);
    std::vector<MeasuringPoint> points;
    std::vector<double> expected;
    for (const double angle : {0.0, 15.0, 25.0, 35.0, 45.0}) {
        points.push_back({{4.0 * std::tan(angle * kDegree), 0, 0}, {0, 1, 0}});
        const double outer = std::cos(double{spot.outer_cone});
        const double inner = std::cos(double{spot.inner_cone});
        const double ramp =
            std::clamp((std::cos(angle * kDegree) - outer) / (inner - outer), 0.0, 1.0);
        expected.push_back(500.0 * ramp * ramp * std::pow(std::cos(angle * kDegree), 3) / 16.0);
    }
    expect_lux(scene_of({spot}), points, expected);
}

TEST(Photometry, ADirectionalLight) {
    SceneLight sun;
    sun.type = LightType::directional;
    sun.direction = glm::normalize(glm::dvec3(0.6, -0.8, 0.0));
    sun.intensity = glm::vec3(5000.0f);
    expect_lux(scene_of({sun}), {{{1e3, 0, 7}, {0, 1, 0}}, {{0, 5, 0}, {-1, 0, 0}}},
               {4000.0, 3000.0});
}

// A lamp of a web, `aim` its vertical angle 0.
Scene web_scene(const IesText& ies, const std::vector<glm::dvec3>& places, const glm::dvec3& aim) {
    Scene scene;
    scene.webs.push_back(read_photometric_web(ies_text(ies), "test"));
    for (const glm::dvec3& place : places) {
        SceneLight light = point_light(place, static_cast<float>(scene.webs[0].peak));
        light.direction = aim;
        light.side = {1, 0, 0};
        light.profile = static_cast<int>(scene.aimed_profiles.size());
        scene.aimed_profiles.push_back({0, false});
        scene.lights.push_back(light);
    }
    return scene;
}

TEST(Photometry, AnIesFileOfACosineEmitter) {
    // I0 cos(gamma): E = I0 cos^4 / h^2 under it, at angles that the file has.
    IesText lambert{.vertical = angle_steps(0, 90, 90)};
    lambert.candela = [](double v, double) { return 400.0 * std::cos(v * kDegree); };
    const Scene scene = web_scene(lambert, {{0, 2, 0}}, {0, -1, 0});
    EXPECT_NEAR(lumens(scene.webs[0]), 400.0 * kPi, 400.0 * kPi * 1e-4);
    std::vector<MeasuringPoint> points;
    std::vector<double> expected;
    for (const double angle : {0.0, 10.0, 45.0, 60.0}) {
        const double around = 0.7;
        const double r = 2.0 * std::tan(angle * kDegree);
        points.push_back({{r * std::cos(around), 0, r * std::sin(around)}, {0, 1, 0}});
        expected.push_back(400.0 * std::pow(std::cos(angle * kDegree), 4) / 4.0);
    }
    expect_lux(scene, points, expected, 1e-10);
}

TEST(Photometry, ARectangleOverAParallelPlane) {
    // Configuration factor of a corner: (X / A atan(Y / A) + Y / B atan(X / B)) / (2 pi) with A^2 =
    // 1 + X^2, B^2 = 1 + Y^2 and sides in heights (Howell, B-3); four of them below the middle.
    const double width = 2.0, height = 1.0, h = 1.5, luminance = 3000.0;
    SceneLight panel = point_light({0, h, 0}, static_cast<float>(luminance * width * height));
    panel.type = LightType::rectangle;
    panel.direction = {0, -1, 0};
    panel.side = {1, 0, 0};
    panel.width = static_cast<float>(width);
    panel.height = static_cast<float>(height);
    const auto corner = [&](double a, double b) {
        const double x = a / h, y = b / h;
        const double p = std::sqrt(1.0 + x * x), q = std::sqrt(1.0 + y * y);
        return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2.0 * kPi);
    };
    const double middle = 4.0 * corner(width / 2, height / 2);
    const double below_corner = corner(width, height);
    expect_lux(scene_of({panel}),
               {{{0, 0, 0}, {0, 1, 0}},
                {{width / 2, 0, height / 2}, {0, 1, 0}},
                {{0, 2 * h, 0}, {0, -1, 0}}},
               {kPi * luminance * middle, kPi * luminance * below_corner, 0.0}, 1e-9);
}

// Bilinear between steps of 5 and 15 degrees of the function that the file holds.
double street_candela(const std::function<double(double, double)>& file, double v, double h) {
    const double v0 = 5.0 * std::min(std::floor(v / 5.0), 35.0);
    const double h0 = 15.0 * std::min(std::floor(h / 15.0), 23.0);
    const double s = (v - v0) / 5.0, t = (h - h0) / 15.0;
    return (1 - t) * ((1 - s) * file(v0, h0) + s * file(v0 + 5.0, h0)) +
           t * ((1 - s) * file(v0, h0 + 15.0) + s * file(v0 + 5.0, h0 + 15.0));
}

TEST(Photometry, AStreetOfLuminaires) {
    const IesText ies = uneven_ies();
    std::vector<glm::dvec3> places;
    for (int i = 0; i < 12; ++i) places.emplace_back(25.0 * i, 8.0, i % 2 == 0 ? -4.0 : 4.0);
    const Scene scene = web_scene(ies, places, {0, -1, 0});
    std::vector<MeasuringPoint> points;
    std::vector<double> expected;
    for (int i = 0; i < 40; ++i) {
        for (int k = 0; k < 5; ++k) {
            const glm::dvec3 p(100.0 + 1.25 * i, 0.0, -3.0 + 1.5 * k);
            double sum = 0.0;
            for (const glm::dvec3& place : places) {
                const glm::dvec3 way = p - place;
                const double d2 = glm::dot(way, way), d = std::sqrt(d2);
                const double v = std::acos(-way.y / d) / kDegree;
                // Horizontal angle 0 along +X, 90 along side x down = +X x -Y = -Z.
                double h = std::atan2(-way.z, way.x) / kDegree;
                if (h < 0.0) h += 360.0;
                sum += street_candela(ies.candela, v, h) * (-way.y / d) / d2;
            }
            points.push_back({p, {0, 1, 0}});
            expected.push_back(sum);
        }
    }
    expect_lux(scene, points, expected, 1e-7);  // intensities are float32
}

// All light of a closed room arrives somewhere: the mean over its walls is 4 pi I / area. What a
// room of reflectance rho would have is 1 / (1 - rho) of that.
TEST(Photometry, TheWallsOfARoomGetTheFlux) {
    const glm::dvec3 size(4, 3, 5);
    const int steps = 40;
    std::vector<MeasuringPoint> points;
    std::vector<double> areas;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (const double side : {0.0, 1.0}) {
            for (int i = 0; i < steps * steps; ++i) {
                MeasuringPoint point;
                point.position[axis] = side * size[axis];
                point.position[u] = (i % steps + 0.5) / steps * size[u];
                point.position[v] = (i / steps + 0.5) / steps * size[v];
                point.normal = glm::dvec3(0.0);
                point.normal[axis] = 1.0 - 2.0 * side;
                points.push_back(point);
                areas.push_back(size[u] * size[v] / (steps * steps));
            }
        }
    }
    const std::vector<double> lux =
        by_kernels(scene_of({point_light({1.5, 1.8, 2.0}, 100.0f)}), points);
    const double flux = std::inner_product(lux.begin(), lux.end(), areas.begin(), 0.0);
    EXPECT_NEAR(flux / (400.0 * kPi), 1.0, 1e-3);  // of the midpoint rule
}

std::vector<SceneLight> ranged_lights(std::size_t count) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::vector<SceneLight> lights;
    for (std::size_t i = 0; i < count; ++i) {
        SceneLight light =
            point_light({100 * unit(random), 1.0 + 3 * unit(random), 100 * unit(random)}, 50.0f);
        light.range = static_cast<float>(3.0 + 9.0 * unit(random));
        lights.push_back(light);
    }
    return lights;
}

std::vector<MeasuringPoint> scattered_points(std::size_t count) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::vector<MeasuringPoint> points;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 n(unit(random) - 0.5, unit(random), unit(random) - 0.5);
        points.push_back({{120 * unit(random) - 10, 2 * unit(random), 120 * unit(random) - 10},
                          glm::normalize(n)});
    }
    return points;
}

// Lists lose nothing, in frames of 65536 points and the rest.
TEST(Photometry, ManyPointsHaveTheLightsOfTheirLists) {
    const Scene scene = scene_of(ranged_lights(700));
    const std::vector<MeasuringPoint> points = scattered_points(66000);
    const std::vector<double> kernels = by_kernels(scene, points);
    const ExactLighting exact(scene);
    double most = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < points.size(); i += 61) {
        const double lux = exact.at(points[i]).lux;
        most = std::max(most, lux);
        largest = std::max(largest, std::abs(kernels[i] - lux));
    }
    EXPECT_LE(largest, kKernelError * most);
    EXPECT_GT(largest, 0.0);
}

TEST(Photometry, WhatRangesCutOffIsBounded) {
    const Scene scene = scene_of(ranged_lights(50));
    Scene unbounded = scene;
    for (SceneLight& light : unbounded.lights) light.range = 0.0f;
    const std::vector<MeasuringPoint> points = scattered_points(1000);
    const std::vector<double> bounds = range_loss_bounds(scene, points, order_in_groups(points));
    const ExactLighting ranged(scene), all(unbounded);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const ExactIlluminance at = ranged.at(points[i]);
        const double whole = all.at(points[i]).lux;
        ASSERT_NEAR(at.lux + at.range_loss, whole, 1e-10 * whole) << i;
        ASSERT_LE(at.range_loss, bounds[i]) << i;
    }
    EXPECT_EQ(range_loss_bounds(unbounded, points, order_in_groups(points)),
              std::vector<double>(points.size(), 0.0));
}

// Of a light straight ahead the bound is what the range cuts off, within it and beyond.
TEST(Photometry, TheBoundOfALightAheadIsExact) {
    for (const float range : {1.5f, 2.0f, 4.0f}) {
        Scene scene = scene_of({point_light({0, 2, 0}, 100.0f)});
        scene.lights[0].range = range;
        const std::vector<MeasuringPoint> point(1);
        const double part = std::min(std::pow(2.0 / range, 4.0), 1.0);
        EXPECT_NEAR(ExactLighting(scene).at(point[0]).range_loss, 25.0 * part, 1e-12);
        EXPECT_NEAR(range_loss_bounds(scene, point, order_in_groups(point))[0], 25.0 * part, 1e-12);
    }
}

// Of points of one group that face a light the bound is that of the one at its range, where it cuts
// off most: whether the group lies within the range, around it or beyond.
TEST(Photometry, TheBoundOfAGroupIsThatOfItsWorstPoint) {
    const glm::dvec3 light(0, 0.5, 0);
    Scene scene = scene_of({point_light(light, 100.0f)});
    scene.lights[0].range = 2.0f;
    for (const double start : {0.0, 1.5, 3.0}) {
        std::vector<MeasuringPoint> points;
        for (int i = 0; i < 200; ++i) {
            const glm::dvec3 at(start + 0.0075 * i, 0, 0);
            points.push_back({at, glm::normalize(light - at)});
        }
        const double bound = range_loss_bounds(scene, points, order_in_groups(points))[0];
        const ExactLighting exact(scene);
        double most = 0.0;
        for (const MeasuringPoint& point : points) {
            most = std::max(most, exact.at(point).range_loss);
        }
        EXPECT_LE(most, bound * (1.0 + 1e-12)) << start;  // rounding of float64
        EXPECT_NEAR(most, bound, 0.01 * bound) << start;
    }
}

TEST(Photometry, ALightAtThePointLosesNothing) {
    Scene scene = scene_of({point_light({0, 2, 0}, 100.0f)});
    scene.lights[0].range = 5.0f;
    const std::vector<MeasuringPoint> point = {{{0, 2, 0}, {0, 1, 0}}};
    EXPECT_EQ(range_loss_bounds(scene, point, order_in_groups(point))[0], 0.0);
}

// From under the end of a tube on, points of one group: what its range takes away is largest at the
// nearest ones, since the tube is wide for them.
TEST(Photometry, WhatTheRangeOfATubeCutsOffIsBounded) {
    SceneLight tube = point_light({0, 2, 0}, 1000.0f);
    tube.type = LightType::rectangle;
    tube.direction = {0, -1, 0};
    tube.side = {1, 0, 0};
    tube.width = 1.2f;
    tube.height = 0.01f;
    tube.range = 5.0f;
    const Scene scene = scene_of({tube});
    std::vector<MeasuringPoint> points;
    for (int i = 0; i < 60; ++i) points.push_back({{0.6 + 0.01 * i, 1.99, 0}, {0, 1, 0}});
    const std::vector<double> bounds = range_loss_bounds(scene, points, order_in_groups(points));
    const ExactLighting exact(scene);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_LE(exact.at(points[i]).range_loss, bounds[i]) << i;
    }
    EXPECT_LE(bounds[0], 100.0);
}

TEST(Photometry, TheLargestContributorsComeFirst) {
    const Scene scene = scene_of({point_light({0, 4, 0}, 100.0f), point_light({0, 1, 0}, 10.0f),
                                  point_light({0, -1, 0}, 999.0f), point_light({0, 2, 0}, 100.0f),
                                  point_light({0, 10, 0}, 100.0f)});
    const ExactIlluminance at = ExactLighting(scene).at({});
    EXPECT_EQ(at.largest[0].light, 3u);
    EXPECT_EQ(at.largest[1].light, 1u);
    EXPECT_EQ(at.largest[2].light, 0u);
    EXPECT_DOUBLE_EQ(at.largest[0].lux, 25.0);
    const Scene one = scene_of({point_light({0, 1, 0}, 10.0f)});
    EXPECT_EQ(ExactLighting(one).at({}).largest[1].lux, 0.0);
}

TEST(Photometry, GroupsHoldEachPointOnce) {
    for (const std::size_t count : {0u, 1u, 255u, 256u, 257u, 1000u}) {
        std::vector<std::uint32_t> order = order_in_groups(scattered_points(count));
        std::sort(order.begin(), order.end());
        std::vector<std::uint32_t> all(count);
        std::iota(all.begin(), all.end(), 0u);
        EXPECT_EQ(order, all);
    }
    // Groups of a field of 64 x 64 points are 16 x 16: their boxes are an eighth of its size.
    std::vector<MeasuringPoint> field;
    for (int i = 0; i < 4096; ++i) field.push_back({{i % 64, 0, i / 64}, {0, 1, 0}});
    const std::vector<std::uint32_t> order = order_in_groups(field);
    for (std::size_t first = 0; first < order.size(); first += kGroupPoints) {
        Box box;
        for (std::size_t i = 0; i < kGroupPoints; ++i) box.add(field[order[first + i]].position);
        EXPECT_LE(std::max(box.size().x, box.size().z), 15.0);
    }
}

}  // namespace
}  // namespace kilolux
