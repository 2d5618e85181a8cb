// SPDX-License-Identifier: Apache-2.0
// Culling of spheres that are tangent, tiny, huge or around the camera.
#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "host/certify/cases.h"
#include "host/render/lights/light_rows.h"

namespace kilolux {
namespace {

ViewShape small_shape(uint width = 97, uint height = 65) {
    ViewShape shape = square_pixels(width, height);
    // View space equals camera-relative world space, so positions reach the device unrounded.
    shape.rotated = false;
    return shape;
}

LightingCase usual_case() { return noise_case(small_shape(), noise_depth(0.3, 60.0, 0.1, 4)); }

// Where the device sees a pixel's surface.
glm::dvec3 point_of(const Planes& planes, uint pixel) {
    return planes.vector(SURFACE_POSITION, pixel % planes.view.width, pixel / planes.view.width);
}

Planes planes_of(const Gpu& gpu, const LightingCase& input) {
    return decode(gpu, input.features, upload_gbuffer(gpu, input.image));
}

float nudged(double value, int ulp) {
    const auto bits = std::bit_cast<int>(static_cast<float>(value));
    return std::bit_cast<float>(bits + ulp);
}

glm::dvec3 rounded(const glm::dvec3& v) { return glm::vec3(v); }

// A corner of the coarse grid's cells: a tile corner's ray at a slice's end.
glm::dvec3 grid_corner(const View& view, const ClusterGrid& grid, Random& random) {
    const double z = depth_of_slice(grid, random.below(grid.slices + 1));
    const uint column = random.below(grid.tiles_x + 1) * grid.tile_width;
    const uint row = random.below(grid.tiles_y + 1) * grid.tile_height;
    return position_at(view, column, row, z);
}

// A point light whose range is not rounded; it may be denormal.
Light light_of_range(const glm::dvec3& position, float range) {
    Light light = point_light(position, 1.0);
    light.position_range.w = range;
    return light;
}

int within_four_ulp(Random& random) { return static_cast<int>(random.below(9)) - 4; }

// A sphere on a face, edge or corner of cells whose surface touches another of them, or a pixel.
Light touching_light(const View& view, const ClusterGrid& grid, glm::dvec3 pixel, uint kind,
                     Random& random) {
    glm::dvec3 center = grid_corner(view, grid, random);
    const glm::dvec3 other = grid_corner(view, grid, random);
    // On a face or an edge of the cells rather than their corner.
    if (kind % 3 == 1) center = (center + other) * 0.5;
    if (kind % 3 == 2) center = center + random.direction() * (0.1 * length(center));
    center = rounded(center);
    double distance = length(center - pixel);
    if (kind % 4 == 0) distance = std::abs(center.z - other.z);
    if (kind % 4 == 1) distance = length(center - other);
    return light_of_range(center, nudged(std::max(distance, 1e-3), within_four_ulp(random)));
}

struct TangentLights {
    std::vector<Light> lights;
    std::vector<uint> pixels;  // that each light touches
};

TangentLights tangent_lights(const Planes& planes, uint count, Random& random) {
    TangentLights out;
    for (uint i = 0; i < count; ++i) {
        out.pixels.push_back(random.below(planes.view.width * planes.view.height));
        const glm::dvec3 p = point_of(planes, out.pixels.back());
        const double wanted = random.log_uniform(1e-4, 0.3) * glm::length(p);
        const glm::dvec3 center = rounded(p + random.direction() * wanted);
        out.lights.push_back(
            light_of_range(center, nudged(glm::length(center - p), within_four_ulp(random))));
    }
    return out;
}

}  // namespace

void try_huge_ranges(const Gpu& gpu, Findings& findings) {
    LightingCase input = usual_case();
    Random random(9);
    constexpr double kScene = 60.0;
    for (int i = 0; i < 400; ++i) {
        const double range = kScene * random.log_uniform(1e3, 1e6);
        // Around the camera, beside it, behind it, and behind it by most of the range.
        glm::dvec3 p = random.point(kScene);
        if (i % 4 == 1) p.z = std::abs(p.z);
        if (i % 4 == 2) p = {0, 0, 0.9 * range};
        if (i % 4 == 3) p = random.direction() * (0.95 * range);
        input.lights.push_back(
            point_light(p, range, glm::dvec3{1, 1, 1} * std::max(dot(p, p), 1.0)));
    }
    const DeviceResult result = check_lists(findings, gpu, input, 120000);
    std::uint64_t short_lists = 0;
    for (const ActiveCluster& c : result.lists.clusters) short_lists += c.list_count != 400;
    findings.none("active lists without all lights", short_lists, result.lists.clusters.size());
    double cells = 0.0;
    for (const LightExtent& extent : result.extents) {
        const auto count = [](uint packed) { return (packed >> 16) + 1.0 - (packed & 0xffffu); };
        cells = std::max(cells, count(extent.slices) * count(extent.rows) * count(extent.columns));
    }
    findings.at_most("cells walked for a light / all cells", cells / result.grid.cluster_count,
                     1.0);
}

void try_spheres_at_the_camera(const Gpu& gpu, Findings& findings) {
    // Grid and pixels from 0.02 m on; spheres across z = 0 and the near plane at 0.02 m.
    ViewShape shape{64, 48};
    shape.near = 0.02;
    LightingCase input = noise_case(shape, noise_depth(0.02, 2.0, 0, 4));
    input.request = {4, 3, 4, 0.02f, 2.0f, 0.0f};
    input.features.light_index_bits = 32;
    Random random(11);
    for (int i = 0; i < 100000; ++i) {
        const double range = random.log_uniform(0.01, 0.6);
        const double plane = i % 2 == 0 ? 0.0 : -0.02;
        const glm::dvec3 p{random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6),
                           plane + random.uniform(-1, 1) * range};
        input.lights.push_back(point_light(world_from_view(input.image.view, p), range));
    }
    const DeviceResult result = light_on_device(gpu, input);
    const std::uint64_t pairs = check_none_missing(findings, input, result, 200);
    findings.at_least("pairs that reach", pairs, 50000);
    check_same_bits(findings, "bits of lists against all lights", result.listed, result.all);
}

void try_boundaries_and_tangents(const Gpu& gpu, Findings& findings) {
    LightingCase input = usual_case();
    const View& view = input.image.view;
    const ClusterGrid grid = grid_of(input);
    const Planes planes = planes_of(gpu, input);
    const std::vector<uint> pixels = input.image.surface_pixels();
    Random random(12);
    for (uint i = 0; i < 3000; ++i) {
        const uint pixel = pixels[random.below(static_cast<uint>(pixels.size()))];
        input.lights.push_back(touching_light(view, grid, point_of(planes, pixel), i, random));
    }
    check_lists(findings, gpu, input, 50000);
}

void try_tiny_lights(const Gpu& gpu, Findings& findings) {
    // Pixels at 0.5 m and at 1 km, each with a light at its point or within r of it.
    constexpr float kTiny[] = {1e-6f, 1e-3f, 1e-20f, 1e-38f, 1e-40f, 1e-45f};
    for (const double z : {0.5, 1000.0}) {
        LightingCase input = noise_case(small_shape(), noise_depth(z, 1.1 * z, 0, 4));
        input.request = {6, 4, 4, 0.25f, 2000.0f, 0.0f};
        const Planes planes = planes_of(gpu, input);
        uint index = 0;
        for (const uint pixel : input.image.surface_pixels()) {
            const float range = kTiny[index % 6];
            glm::dvec3 p = point_of(planes, pixel);
            // Towards the eye by half the range, so that the light reaches the surface from the
            // front.
            if (index++ % 2 == 0) p = rounded(p + p * (-0.5 * range / length(p)));
            input.lights.push_back(light_of_range(p, range));
        }
        check_lists(findings, gpu, input, 380);
    }
    std::vector<SceneLight> lights(5);
    constexpr float kRanges[] = {0.0f, -0.0f, -1e-6f, -1.0f, 1e-40f};
    for (std::size_t i = 0; i < 5; ++i) lights[i].range = kRanges[i];
    const LightRows rows = make_light_rows(lights, glm::dvec3(0.0));
    findings.require("lights of range <= 0 rejected and counted",
                     rows.rejected == 4 && rows.local.size() == 1,
                     fmt::format("{} rejected of 4", rows.rejected));
}

void try_tangent_spheres(const Gpu& gpu, Findings& findings) {
    LightingCase input = noise_case(small_shape(33, 17), noise_depth(0.5, 50.0, 0, 4));
    input.features.light_index_bits = 32;
    input.request = {3, 2, 4, 0.5f, 50.0f, 0.0f};
    const GBuffer gbuffer = upload_gbuffer(gpu, input.image);
    const Planes planes = decode(gpu, input.features, gbuffer);
    const ClusterGrid grid = grid_of(input);
    LightLists light_lists(gpu, default_tuning(gpu.info), input.features);
    StageTimer timer;
    Random random(29);
    std::uint64_t missed = 0;
    std::uint64_t reaching = 0;
    constexpr uint kBatches = 5;
    constexpr uint kLights = 200000;
    for (uint batch = 0; batch < kBatches; ++batch) {
        const TangentLights tangent = tangent_lights(planes, kLights, random);
        const HostLists lists = download_lists(
            gpu, input.features,
            light_lists.run(upload_lights(gpu, tangent.lights), gbuffer, grid, timer));
        for (uint i = 0; i < kLights; ++i) {
            const uint pixel = tangent.pixels[i];
            const float4 c = tangent.lights[i].position_range;
            const glm::dvec3 v = point_of(planes, pixel) - xyz(c);
            if (glm::dot(v, v) >= double{c.w} * c.w) continue;
            ++reaching;
            const auto list = lists.list_at(grid, planes, pixel % 33, pixel / 33);
            missed += std::binary_search(list.begin(), list.end(), i) ? 0 : 1;
        }
    }
    findings.none("missed lights", missed, std::uint64_t{kBatches} * kLights);
    findings.at_least("tangent lights that reach", reaching, 300000);
}

}  // namespace kilolux
