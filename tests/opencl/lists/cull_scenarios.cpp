// SPDX-License-Identifier: Apache-2.0
#include "tests/opencl/lists/cull_scenarios.h"

#include <bit>
#include <cmath>

#include "host/certify/synthetic/probe.h"

namespace kilolux {
namespace {

constexpr uint kPixelSample = 900;

ViewShape orthographic(double near, double far) {
    ViewShape shape{97, 65, 30.0, 20.0};
    shape.near = near;
    shape.far = far;
    shape.orthographic = true;
    return shape;
}

ViewShape sheared(double x, double y) {
    ViewShape shape = square_pixels(97, 65);
    shape.shift_x = x;
    shape.shift_y = y;
    return shape;
}

ViewShape oblique() {
    ViewShape shape = square_pixels(97, 65);
    shape.oblique_x = 0.3;
    shape.oblique_y = -0.05;
    return shape;
}

// A random pixel's position in view space, of those with a surface.
glm::dvec3 some_position(const CullCase& c, Random& random) {
    const uint pixel = c.pixels[random.below(static_cast<uint>(c.pixels.size()))];
    const View& view = c.planes.view;
    return c.planes.vector(SURFACE_POSITION, pixel % view.width, pixel / view.width);
}

glm::dvec3 on_a_plane(const CullCase& c, Random& random) {
    const View& view = c.planes.view;
    const double z = depth_of_slice(c.grid, random.below(c.grid.slices + 1));
    const uint column = random.below(c.grid.tiles_x + 1) * c.grid.tile_width;
    const uint row = random.below(c.grid.tiles_y + 1) * c.grid.tile_height;
    return position_at(view, column, row, z);
}

struct Sphere {
    glm::dvec3 center;
    double range;
};

Sphere adversarial_sphere(const CullCase& c, uint kind, Random& random) {
    const glm::dvec3 p = some_position(c, random);
    const double size = std::max(length(p), 1e-3);
    switch (kind) {
        case 0:
            return {p + random.point(0.5 * size), random.log_uniform(1e-3, 1.0) * size};
        case 1: {
            const double range = random.log_uniform(1e-6, 10.0) * size;
            return {p + random.direction() * range, range};
        }
        case 2: {
            const glm::dvec3 center = on_a_plane(c, random);
            return {center, random.log_uniform(1e-4, 1.0) * std::max(length(center), 1e-3)};
        }
        case 3: {
            const double range = random.log_uniform(1.0, 1e6) * size;
            return {p + random.direction() * range * random.uniform(0.9, 1.1), range};
        }
        case 4: {
            const double range = random.log_uniform(1e-6, 1e-3) * size;
            return {p + random.point(range), range};
        }
        default: {
            const glm::dvec3 center = random.direction() * random.log_uniform(1e-3, 2.0) * size;
            return {{center.x, center.y, std::abs(center.z)}, random.log_uniform(0.5, 4.0) * size};
        }
    }
}

// Sets ranges to the distance to a pixel in the device's numbers, at most 4 ulp off.
void make_tangent(const Gpu& gpu, CullCase& c, Random& random) {
    PrepareLights prepare(gpu, default_tuning(gpu.info));
    StageTimer timer;
    const PreparedLights prepared =
        prepare.enqueue(upload_lights(gpu, c.lights), c.gbuffer.view, c.grid, timer);
    const auto bounds = download<float4>(gpu, prepared.bounds, c.lights.size());
    for (std::size_t i = 1; i < c.lights.size(); i += 6) {
        const glm::dvec3 center{bounds[i].x, bounds[i].y, bounds[i].z};
        const auto distance = static_cast<float>(length(some_position(c, random) - center));
        if (!(distance > 1e-18f)) continue;
        const uint bits = std::bit_cast<uint>(distance) - 4 + random.below(9);
        c.lights[i].position_range.w = std::bit_cast<float>(bits);
    }
}

// All pixels with a surface, or a sample of many.
std::vector<uint> sampled_pixels(const Synthetic& image, Random& random) {
    const std::vector<uint> pixels = image.surface_pixels();
    if (pixels.size() <= std::size_t{2} * kPixelSample) return pixels;
    std::vector<uint> sample;
    for (uint i = 0; i < kPixelSample; ++i) {
        sample.push_back(pixels[random.below(static_cast<uint>(pixels.size()))]);
    }
    return sample;
}

}  // namespace

std::vector<CullScenario> cull_scenarios() {
    const GridRequest usual{16, 9, 4, 0.5f, 50.0f, 0.0f};
    const GridRequest fine{64, 64, 16, 0.5f, 50.0f, 0.0f};
    const DepthOf noise = noise_depth(0.2, 90.0, 0.2, 4);
    ViewShape straight = square_pixels(97, 65);
    straight.rotated = false;
    GridRequest padded = usual;
    padded.position_pad = 1e-3f;
    return {
        {"noise", square_pixels(97, 65), usual, noise},
        {"noise, fine grid", straight, fine, noise},
        {"smooth", square_pixels(97, 65), usual, slanted_depth(1.0, 20.0, 97)},
        {"far/near 1e7",
         square_pixels(97, 65),
         {16, 9, 4, 1e-3f, 1e4f, 0.0f},
         noise_depth(1e-3, 1e4, 0, 9)},
        {"far 1e6", straight, {16, 9, 1, 0.1f, 1e6f, 0.0f}, noise_depth(0.1, 1e6, 0, 9)},
        {"sheared", sheared(0.5, -0.5), usual, noise},
        {"sheared beside the axis", sheared(2.5, 1.5), usual, noise},
        {"oblique near plane", oblique(), usual, noise_depth(0.2, 3.0, 0.2, 4)},
        {"orthographic, near 0", orthographic(0.0, 90.0), usual, noise_depth(0.0, 89.0, 0.2, 4)},
        {"orthographic, near -50", orthographic(-50.0, 90.0), fine,
         noise_depth(-49.0, 89.0, 0.2, 4)},
        {"one pixel", square_pixels(1, 1), usual, noise},
        {"17x31", square_pixels(17, 31), usual, noise},
        {"8192x1", {8192, 1, 1.0, 0.01}, usual, noise},
        {"1919x1079", square_pixels(1919, 1079), usual, slanted_depth(0.3, 70.0, 1919)},
        {"stored positions", square_pixels(97, 65), padded, noise, GBUFFER_FULL},
        {"spots", square_pixels(97, 65), usual, noise, GBUFFER_PACKED, true},
        {"spots, fine grid", straight, fine, slanted_depth(1.0, 20.0, 97), GBUFFER_PACKED, true},
        {"spots, sheared", sheared(0.5, -0.5), usual, noise, GBUFFER_PACKED, true},
        {"spots, orthographic", orthographic(-5.0, 90.0), usual, noise_depth(-4.0, 89.0, 0.2, 4),
         GBUFFER_PACKED, true}};
}

CullCase make_cull_case(const Gpu& gpu, const CullScenario& scenario) {
    CullCase c;
    c.features.gbuffer = scenario.layout;
    c.features.spot_lights = scenario.spots;
    const View view = make_view(scenario.shape);
    c.grid = make_cluster_grid(scenario.request, view.width, view.height);
    const Synthetic image = make_synthetic(view, c.features, scenario.depth);
    c.gbuffer = upload_gbuffer(gpu, image);
    c.planes = decode(gpu, c.features, c.gbuffer);
    Random random(static_cast<std::uint32_t>(scenario.name.size()) * 77 + view.width);
    c.pixels = sampled_pixels(image, random);
    for (uint i = 0; i < scenario.light_count; ++i) {
        const Sphere sphere = adversarial_sphere(c, i % 6, random);
        const Light point = point_light(world_from_view(view, sphere.center), sphere.range);
        // Every twelfth shines into a half-space, as flat lights do.
        const double outer = i % 12 == 11 ? 1.5707963267948966
                             : i % 12 < 6 ? random.uniform(0.01, 0.2)
                                          : random.uniform(0.2, 1.5707963);
        c.lights.push_back(scenario.spots && i % 4 != 0
                               ? spot_light(point, random.direction(), 0.5 * outer, outer)
                               : point);
    }
    make_tangent(gpu, c, random);
    return c;
}

}  // namespace kilolux
