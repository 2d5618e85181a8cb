// SPDX-License-Identifier: Apache-2.0
// Lights in view space, and the part of the grid that each can touch, against double.
#include "host/stages/lights/prepare_lights.h"

#include <gtest/gtest.h>

#include "host/certify/synthetic/host_lists.h"
#include "tests/support/slice_search.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

// Three products and their sums, u = 6e-8 each.
constexpr double kRotationTolerance = 4e-7;

struct Prepared {
    std::vector<ShadeLight> lights;
    std::vector<float4> bounds;
    std::vector<LightExtent> extents;
    std::vector<DirectionalLight> directional;
};

Prepared prepare(int lanes, int group, const LightInput& input, const View& view,
                 const ClusterGrid& grid) {
    const Gpu gpu = test_gpu(lanes);
    Tuning tuning = default_tuning(gpu.info);
    tuning.light_group = group;
    PrepareLights stage(gpu, tuning);
    StageTimer timer;
    const PreparedLights out = stage.enqueue(input, view, grid, timer);
    EXPECT_EQ(out.count, input.count);
    return {download<ShadeLight>(gpu, out.lights, out.count),
            download<float4>(gpu, out.bounds, out.count),
            download<LightExtent>(gpu, out.extents, out.count),
            download<DirectionalLight>(gpu, out.directional, out.directional_count)};
}

glm::dvec3 vec(float4 v) { return {v.x, v.y, v.z}; }

void expect_rotated(const View& view, const std::vector<Light>& lights, const Prepared& found) {
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const ShadeLight& light = found.lights[i];
        const glm::dvec3 p = view_from_world(view, vec(lights[i].position_range));
        const double range = lights[i].position_range.w;
        ASSERT_LE(length(vec(light.position_inv_range2) - p), kRotationTolerance * length(p))
            << "light " << i;
        ASSERT_NEAR(light.position_inv_range2.w * range * range, 1.0, 4e-7) << "light " << i;
        ASSERT_LE(length(vec(light.axis_cos) - view_from_world(view, vec(lights[i].axis_cos))),
                  kRotationTolerance);
        ASSERT_EQ(light.axis_cos.w, lights[i].axis_cos.w);
        ASSERT_EQ(length(vec(light.color_scale) - vec(lights[i].color_scale)), 0.0);
        ASSERT_EQ(light.color_scale.w, lights[i].color_scale.w);
        ASSERT_EQ(length(vec(found.bounds[i]) - vec(light.position_inv_range2)), 0.0);
        ASSERT_EQ(found.bounds[i].w, light.position_inv_range2.w);
    }
}

bool within(uint packed, uint value) {
    return (packed & 0xffffu) <= value && value <= packed >> 16;
}

// Points of the sphere that lie in the image lie in the extent.
void expect_extents_cover(const View& view, const ClusterGrid& grid,
                          const std::vector<Light>& lights, const Prepared& found) {
    Random random(31);
    std::size_t inside = 0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        for (int sample = 0; sample < 50; ++sample) {
            const double radius =
                lights[i].position_range.w * (sample % 2 == 0 ? 1.0 : random.unit());
            const glm::dvec3 p = vec(found.bounds[i]) + random.direction() * radius;
            const double z = -p.z;
            if (view.orthographic == 0 && z <= 0) continue;
            const double s = view.orthographic != 0 ? 1 : z;
            const double px = (p.x / s - view.ray.y) / view.ray.x;
            const double py = (p.y / s - view.ray.w) / view.ray.z;
            if (px < 0 || py < 0 || px >= view.width || py >= view.height) continue;
            ++inside;
            ASSERT_TRUE(within(found.extents[i].columns, static_cast<uint>(px) / grid.tile_width))
                << "light " << i;
            ASSERT_TRUE(within(found.extents[i].rows, static_cast<uint>(py) / grid.tile_height))
                << "light " << i;
            ASSERT_TRUE(within(found.extents[i].slices, slice_by_search(grid, z))) << "light " << i;
        }
    }
    EXPECT_GT(inside, lights.size());
}

TEST(PrepareLights, ViewSpaceAndExtentsAgreeWithDouble) {
    ViewShape shapes[3];
    shapes[1].shift_x = 0.7;
    shapes[2].orthographic = true;
    shapes[2].half_x = 20;
    for (const ViewShape& shape : shapes) {
        const View view = make_view(shape);
        const ClusterGrid grid =
            make_cluster_grid({16, 9, 4, 0.5f, 50.0f, 0.0f}, view.width, view.height);
        RandomLightOptions mix;
        mix.count = 3001;
        mix.spots = 0.3;
        mix.range_min = 1e-4;
        mix.range_max = 100;
        mix.spread = 2;
        const std::vector<Light> lights = random_lights(view, mix);
        const Prepared found = prepare(0, 16, upload_lights(test_gpu(), lights), view, grid);
        expect_rotated(view, lights, found);
        expect_extents_cover(view, grid, lights, found);
    }
}

// Spheres are wider by 1e-6 of each coordinate: rounding on the way to tiles loses no light. Here
// they end that near to a slice, far out along each axis.
TEST(PrepareLights, ExtentsAreWiderBySharesOfEveryCoordinate) {
    const View view = make_view(ViewShape{});
    const ClusterGrid grid =
        make_cluster_grid({16, 9, 4, 0.5f, 50.0f, 0.0f}, view.width, view.height);
    const double depth = depth_of_slice(grid, 17);
    Random random(5);
    std::vector<Light> lights;
    for (const glm::dvec2 at : {glm::dvec2(0.0), glm::dvec2(1000, 0), glm::dvec2(0, -1000)}) {
        for (int i = 0; i < 200; ++i) {
            const double pad = 2e-6 * (std::abs(at.x) + std::abs(at.y) + depth);
            const double end = (i % 2 == 0 ? 0.25 : -0.25) + pad * (2.0 * random.unit() - 1.0);
            lights.push_back(
                point_light(world_from_view(view, glm::dvec3(at, -depth - end)), 0.25));
        }
    }
    const Prepared found = prepare(0, 16, upload_lights(test_gpu(), lights), view, grid);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const glm::dvec3 p = vec(found.bounds[i]);
        const double radius = 0.25 + 0.9e-6 * (std::abs(p.x) + std::abs(p.y) + std::abs(p.z));
        ASSERT_TRUE(within(found.extents[i].slices, slice_by_search(grid, -p.z - radius))) << i;
        ASSERT_TRUE(within(found.extents[i].slices, slice_by_search(grid, -p.z + radius))) << i;
    }
}

TEST(PrepareLights, AnyCountLaneWidthAndGroupGivesTheSame) {
    const View view = make_view(ViewShape{});
    const ClusterGrid grid = make_cluster_grid({}, view.width, view.height);
    RandomLightOptions mix;
    mix.count = 257;
    const std::vector<Light> lights = random_lights(view, mix);
    for (const std::size_t count : {0u, 1u, 7u, 8u, 17u, 255u, 256u, 257u}) {
        const std::vector<Light> some(lights.begin(),
                                      lights.begin() + static_cast<std::ptrdiff_t>(count));
        const LightInput input = upload_lights(test_gpu(), some);
        const Prepared expected = prepare(1, 1, input, view, grid);
        expect_rotated(view, some, expected);
        for (const int lanes : {4, 8, 16}) {
            const Prepared found = prepare(lanes, 16, input, view, grid);
            for (std::size_t i = 0; i < count; ++i) {
                ASSERT_EQ(found.extents[i].slices, expected.extents[i].slices) << "light " << i;
                ASSERT_EQ(found.extents[i].columns, expected.extents[i].columns) << "light " << i;
                ASSERT_EQ(found.extents[i].rows, expected.extents[i].rows) << "light " << i;
                ASSERT_EQ(std::memcmp(&found.lights[i], &expected.lights[i], sizeof(ShadeLight)), 0)
                    << "light " << i;
            }
        }
    }
}

TEST(PrepareLights, LightsOutsideTheImageTouchNothing) {
    const View view = make_view(ViewShape{});
    const ClusterGrid grid =
        make_cluster_grid({16, 9, 4, 0.5f, 50.0f, 0.0f}, view.width, view.height);
    const auto at = [&](glm::dvec3 p, double range) {
        return point_light(world_from_view(view, p), range);
    };
    const std::vector<Light> lights = {at({0, 0, 5}, 4.9), at({30, 0, -10}, 1),
                                       at({-30, 0, -10}, 1), at({0, 30, -10}, 1),
                                       at({0, -30, -10}, 1)};
    const Prepared found = prepare(0, 16, upload_lights(test_gpu(), lights), view, grid);
    const auto is_empty = [](uint packed) { return (packed & 0xffffu) > packed >> 16; };
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const LightExtent& e = found.extents[i];
        EXPECT_TRUE(is_empty(e.slices) || is_empty(e.columns) || is_empty(e.rows)) << "light " << i;
    }
}

TEST(PrepareLights, SmallLightsTouchFewTiles) {
    ViewShape shape;
    shape.width = 1600;
    shape.height = 900;
    const View view = make_view(shape);
    const ClusterGrid grid =
        make_cluster_grid({16, 9, 4, 0.5f, 50.0f, 0.0f}, view.width, view.height);
    RandomLightOptions mix;
    mix.count = 500;
    mix.range_min = mix.range_max = 1e-3;
    mix.z_near = 1;
    const Prepared found =
        prepare(0, 16, upload_lights(test_gpu(), random_lights(view, mix)), view, grid);
    for (const LightExtent& e : found.extents) {
        EXPECT_LE(static_cast<int>(e.columns >> 16) - static_cast<int>(e.columns & 0xffffu), 1);
        EXPECT_LE(static_cast<int>(e.rows >> 16) - static_cast<int>(e.rows & 0xffffu), 1);
        EXPECT_LE(static_cast<int>(e.slices >> 16) - static_cast<int>(e.slices & 0xffffu), 1);
    }
}

TEST(PrepareLights, DirectionalLightsAreRotated) {
    const View view = make_view(ViewShape{});
    const std::vector<DirectionalLight> sun = {{{0.48f, 0.6f, 0.64f, 0.0f}, {1, 2, 3, 0}},
                                               {{0, 0, 1, 0}, {4, 5, 6, 0}}};
    const Prepared found =
        prepare(0, 16, upload_lights(test_gpu(), {}, sun), view, make_cluster_grid({}, 64, 48));
    ASSERT_EQ(found.directional.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_LE(length(vec(found.directional[i].to_light) -
                         view_from_world(view, vec(sun[i].to_light))),
                  kRotationTolerance);
        EXPECT_EQ(length(vec(found.directional[i].color) - vec(sun[i].color)), 0.0);
    }
}

}  // namespace
}  // namespace kilolux
