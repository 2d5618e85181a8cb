// SPDX-License-Identifier: Apache-2.0
// The order in which kernels go through lights, and their rows.
#include "host/render/lights/light_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "host/render/lights/generated_lights.h"
#include "host/render/lights/light_rows.h"
#include "host/scene/generated/scenes.h"
#include "kernels/shared/lights/light_order.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

std::vector<SceneLight> random_lights(std::size_t count, float range = 2.0f) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-20.0, 20.0);
    std::vector<SceneLight> lights(count);
    for (SceneLight& light : lights) {
        light.position = {place(random), place(random), place(random)};
        light.range = range;
    }
    return lights;
}

std::vector<SceneLight> sorted(const std::vector<SceneLight>& lights) {
    std::vector<SceneLight> out;
    for (const std::uint32_t light : order_by_place(lights)) out.push_back(lights[light]);
    return out;
}

bool same_places(const std::vector<SceneLight>& a, const std::vector<SceneLight>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const auto& x, const auto& y) { return x.position == y.position; });
}

double mean_step(const std::vector<SceneLight>& lights) {
    double sum = 0.0;
    for (std::size_t i = 1; i < lights.size(); ++i) {
        sum += glm::length(lights[i].position - lights[i - 1].position);
    }
    return sum / static_cast<double>(lights.size() - 1);
}

TEST(LightOrder, NeighboursInSpaceAreNeighbours) {
    const std::vector<SceneLight> lights = random_lights(5000);
    EXPECT_GT(mean_step(lights), 20.0);
    // 5000 lights in 40^3 m^3: 2.3 m from one to the next on a lattice.
    EXPECT_LT(mean_step(sorted(lights)), 5.0);
}

// Culling skips spans of 2048 lights by what they reach, whatever the range is within its octave.
TEST(LightOrder, SpansOfManyLightsAreCompact) {
    constexpr std::size_t kSpan = 2048;
    const auto mean_edge = [](const std::vector<SceneLight>& lights) {
        double sum = 0.0;
        for (std::size_t first = 0; first + kSpan <= lights.size(); first += kSpan) {
            Box box;
            for (std::size_t i = first; i < first + kSpan; ++i) box.add(lights[i].position);
            const glm::dvec3 size = box.size();
            sum += std::max({size.x, size.y, size.z});
        }
        return sum / static_cast<double>(lights.size() / kSpan);
    };
    for (const float range : {0.6f, 0.9f, 1.1f}) {  // about ten lights reach a point
        const std::vector<SceneLight> lights = random_lights(200000, range);
        EXPECT_GT(mean_edge(lights), 39.0);
        const double cube = std::cbrt(40.0 * 40.0 * 40.0 * kSpan / 200000.0);
        EXPECT_LT(mean_edge(sorted(lights)), 2.5 * cube) << range;
    }
}

// Within an octant about the origin the curve goes from each cell to one beside it; a key stands
// for two cells that follow each other.
TEST(LightOrder, FollowsACurveWithoutJumpsInAnOctant) {
    struct Cell {
        uint key;
        glm::ivec3 at;
    };
    constexpr int kEdge = 32;
    for (const int origin : {0, 64, -kEdge, -1024}) {
        std::vector<Cell> cells;
        for (int i = 0; i < kEdge * kEdge * kEdge; ++i) {
            const glm::ivec3 at =
                glm::ivec3(i % kEdge, i / kEdge % kEdge, i / (kEdge * kEdge)) + origin;
            cells.push_back({light_order_key(static_cast<uint>(at.x), static_cast<uint>(at.y),
                                             static_cast<uint>(at.z)),
                             at});
        }
        std::ranges::sort(cells, {}, &Cell::key);
        for (std::size_t i = 1; i < cells.size(); ++i) {
            ASSERT_EQ(cells[i].key - cells[0].key, i / 2) << "from " << origin << ", cell " << i;
            const glm::ivec3 step = glm::abs(cells[i].at - cells[i - 1].at);
            ASSERT_LE(step.x + step.y + step.z, i % 2 == 1 ? 1 : 3);
        }
    }
}

// No two in one cell of the curve, nor in two that follow each other on it: those share a key.
std::vector<SceneLight> lattice_lights(std::size_t count) {
    constexpr std::size_t kEdge = 70;
    std::vector<SceneLight> lights(count);
    for (std::size_t i = 0; i < count; ++i) {
        lights[i].position = {i % kEdge, i / kEdge % kEdge, i / (kEdge * kEdge)};
        lights[i].range = 0.5f;  // two cells from one light to the next
    }
    return lights;
}

// Threads sort parts of many lights: the result does not depend on their order.
TEST(LightOrder, DependsOnPlacesAlone) {
    for (const std::size_t count : {100u, 70001u, 300000u}) {
        std::vector<SceneLight> lights = lattice_lights(count);
        const std::vector<SceneLight> expected = sorted(lights);
        EXPECT_FALSE(same_places(expected, lights));
        std::shuffle(lights.begin(), lights.end(), std::mt19937(9));
        EXPECT_TRUE(same_places(sorted(lights), expected)) << count << " lights";
    }
}

TEST(LightOrder, OfTwoLightsDependsOnNoThird) {
    const std::vector<SceneLight> all = sorted(random_lights(2000));
    std::vector<SceneLight> some = random_lights(2000);
    some.erase(some.begin(), some.begin() + 700);
    std::vector<SceneLight> expected;
    for (const SceneLight& light : all) {
        const bool stays = std::any_of(some.begin(), some.end(), [&](const SceneLight& s) {
            return s.position == light.position;
        });
        if (stays) expected.push_back(light);
    }
    EXPECT_TRUE(same_places(sorted(some), expected));
}

TEST(LightOrder, IsTheSameInAWorldTwiceAsLarge) {
    std::vector<SceneLight> expected = sorted(random_lights(2000));
    std::vector<SceneLight> doubled = random_lights(2000);
    for (SceneLight& light : expected) light.position *= 2.0;
    for (SceneLight& light : doubled) {
        light.position *= 2.0;
        light.range *= 2.0f;
    }
    EXPECT_TRUE(same_places(sorted(doubled), expected));
}

TEST(LightOrder, PutsLightsWithoutAPlaceLastInTheirOrder) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    std::vector<SceneLight> lights = random_lights(10);
    lights[2].type = LightType::directional;
    lights[2].inner_cone = 1.0f;
    lights[3].position.y = kNan;
    lights[5].range = 0.0f;
    lights[6].position.x = std::numeric_limits<double>::infinity();
    const std::vector<SceneLight> out = sorted(lights);
    ASSERT_EQ(out.size(), 10u);
    EXPECT_EQ(out[6].inner_cone, 1.0f);
    EXPECT_TRUE(std::isnan(out[7].position.y));
    EXPECT_EQ(out[8].range, 0.0f);
    EXPECT_TRUE(std::isinf(out[9].position.x));
}

TEST(LightOrder, KeepsTheOrderOfEqualPlacesAndFarOnes) {
    std::vector<SceneLight> lights(6);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        lights[i].range = 1.0f;
        lights[i].position = glm::dvec3(i < 3 ? 1e12 * static_cast<double>(i + 1) : 1.0);
        lights[i].inner_cone = static_cast<float>(i);
    }
    const std::vector<SceneLight> out = sorted(lights);
    for (const std::size_t i : {0u, 1u, 2u})
        EXPECT_EQ(out[i].inner_cone, static_cast<float>(i + 3));
    for (const std::size_t i : {3u, 4u, 5u})
        EXPECT_EQ(out[i].inner_cone, static_cast<float>(i - 3));
}

// The host orders an exported scene's lights: the picture has the bits of the swarm's.
TEST(LightOrder, IsTheDevicesOrderOfGeneratedOnes) {
    const Gpu gpu = test_gpu();
    const Scene scene = make_generated_scene("grid");
    for (const double radius : {0.0, 0.11, 3.0, 1e-30}) {
        for (const double time : {0.0, 1.5, 2048.5}) {
            LightOptions options;
            options.count = 3000;
            options.radius = radius;
            options.box = {{-7.3, -1e-3, 0.1}, {5.9, 4.4, 1e4}};
            GeneratedLights generated(gpu, default_tuning(gpu.info));
            generated.set(options, scene, time);
            const DeviceArray<WorldLight> world(
                new_buffer(gpu, std::vector<WorldLight>(options.count)));
            StageTimer timer;
            generated.place(world, 0, timer);
            generated.read_order();
            const std::vector<SceneLight> lights = generate_lights(options, scene, time);
            const std::vector<std::uint32_t> order = order_by_place(lights);
            for (std::size_t i = 0; i < lights.size(); ++i) {
                ASSERT_EQ(generated.at(i).position, lights[order[i]].position)
                    << radius << " m, " << time << " s, place " << i;
            }
        }
    }
}

SceneLight light_of(LightType type) {
    SceneLight light;
    light.type = type;
    light.range = 5.0f;
    light.direction = {0, -1, 0};
    light.side = {0, 0, 1};
    light.width = 3.0f;
    light.height = 0.5f;
    light.radius = 0.25f;
    return light;
}

TEST(LightRows, OfShapesHaveTheirAxesAndArea) {
    const LightShape rectangle = shape_row(light_of(LightType::rectangle));
    EXPECT_EQ(shape_kind(rectangle), SHAPE_RECTANGLE);
    EXPECT_FALSE(shines_both_ways(rectangle));
    EXPECT_EQ(rectangle.half_x.z, 1.5f);
    EXPECT_EQ(rectangle.half_y.x, -0.25f) << "so that half_x x half_y is down";
    EXPECT_FLOAT_EQ(rectangle.half_y.w, 1.0f / 1.5f);
    SceneLight light = light_of(LightType::disk);
    light.two_sided = true;
    EXPECT_EQ(shape_kind(shape_row(light)), SHAPE_DISK);
    EXPECT_TRUE(shines_both_ways(shape_row(light)));
    const LightShape sphere = shape_row(light_of(LightType::sphere));
    EXPECT_EQ(shape_kind(sphere), SHAPE_SPHERE);
    EXPECT_EQ(sphere.half_x.x, 0.25f);
    EXPECT_FLOAT_EQ(sphere.half_y.w, 5.092958f) << "1 / (pi r^2)";
    for (const LightType type : {LightType::point, LightType::spot}) {
        EXPECT_FALSE(has_size(shape_row(light_of(type))));
    }
}

// Lists take a one-sided light's half-space for the cone of a spot.
TEST(LightRows, OfOneSidedLightsHaveAHalfSpace) {
    for (const LightType type : {LightType::rectangle, LightType::disk, LightType::triangle}) {
        SceneLight light = light_of(type);
        const Light row = world_light(light).light;
        EXPECT_EQ(row.axis_cos.y, -1.0f);
        EXPECT_EQ(row.axis_cos.w, 0.0f);
        EXPECT_EQ(row.color_scale.w, 1.0f);
        light.two_sided = true;
        EXPECT_EQ(world_light(light).light.axis_cos.w, -1.0f);
    }
    EXPECT_EQ(world_light(light_of(LightType::sphere)).light.axis_cos.w, -1.0f);
}

TEST(LightRows, HaveAShapeBesideEachLocalLightOrNone) {
    std::vector<SceneLight> lights = {light_of(LightType::point), light_of(LightType::directional),
                                      light_of(LightType::spot)};
    EXPECT_TRUE(make_light_rows(lights, {}).shapes.empty());
    EXPECT_FALSE(make_light_rows(lights, {}).features.area_lights);
    lights.insert(lights.begin() + 1, light_of(LightType::disk));
    const LightRows rows = make_light_rows(lights, {});
    ASSERT_EQ(rows.local.size(), 3u);
    ASSERT_EQ(rows.shapes.size(), 3u);
    EXPECT_FALSE(has_size(rows.shapes[0]));
    EXPECT_EQ(shape_kind(rows.shapes[1]), SHAPE_DISK);
    EXPECT_FALSE(has_size(rows.shapes[2]));
    EXPECT_TRUE(rows.features.area_lights);
}

TEST(LightRows, LackLightsWhoseSizeIsNone) {
    for (const LightType type : {LightType::rectangle, LightType::disk, LightType::sphere}) {
        EXPECT_TRUE(is_usable(light_of(type), {}));
        for (const float bad : {0.0f, -1.0f, NAN, INFINITY, 1e-30f, 1e30f}) {
            SceneLight light = light_of(type);
            light.width = light.height = light.radius = bad;
            EXPECT_FALSE(is_usable(light, {})) << bad;
        }
        SceneLight light = light_of(type);
        light.profile = 0;
        EXPECT_FALSE(is_usable(light, {})) << "a web is a point's";
    }
}

TEST(LightOrder, OfGeneratedSpheresIsThatOfPoints) {
    const Scene scene = make_generated_scene("grid");
    LightOptions options;
    options.count = 10;
    const std::vector<SceneLight> points = generate_lights(options, scene, 0.0);
    options.size = 0.25;
    std::vector<SceneLight> spheres = generate_lights(options, scene, 0.0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(spheres[i].type, LightType::sphere);
        EXPECT_EQ(std::exchange(spheres[i].radius, 0.0f), 0.25f);
        spheres[i].type = LightType::point;
        EXPECT_EQ(spheres[i], points[i]) << "their intensity, too";
    }
}

TEST(LightOrder, OfNoLightIsNone) { EXPECT_TRUE(sorted({}).empty()); }

}  // namespace
}  // namespace kilolux
