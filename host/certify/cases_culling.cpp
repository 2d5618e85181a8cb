// SPDX-License-Identifier: Apache-2.0
// Spheres that try to slip through the lists.
#include <algorithm>
#include <bit>

#include "host/certify/cases.h"
#include "host/certify/shot.h"
#include "host/render/light_rows.h"

namespace kilolux {
namespace {

ViewShape small_shape() {
    ViewShape shape{97, 65};
    shape.half_y = shape.half_x * 65 / 97;
    // View space and camera-relative world space are one: positions reach the device unrounded.
    shape.rotated = false;
    return shape;
}

Shot usual_shot() { return noise_shot(small_shape(), noise_depth(0.3, 60.0, 0.1, 4)); }

// Where the device sees a pixel's surface.
Vec3d point_of(const Planes& planes, uint pixel) {
    return planes.vector(SURFACE_POSITION, pixel % planes.view.width, pixel / planes.view.width);
}

std::vector<uint> drawn_pixels(const Shot& shot) {
    std::vector<uint> pixels;
    const View& view = shot.image.view;
    for (uint i = 0; i < view.width * view.height; ++i) {
        if (is_drawn(shot, i % view.width, i / view.width)) pixels.push_back(i);
    }
    return pixels;
}

Planes planes_of(const Gpu& gpu, const Shot& shot) {
    return decode(gpu, shot.features, upload_gbuffer(gpu, shot.image));
}

float nudged(double value, int ulp) {
    const auto bits = std::bit_cast<int>(static_cast<float>(value));
    return std::bit_cast<float>(bits + ulp);
}

Vec3d rounded(Vec3d v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// A corner of the coarse grid's cells: a tile corner's ray at a slice's end.
Vec3d grid_corner(const View& view, const ClusterGrid& grid, Random& random) {
    const double z = depth_of_slice(grid, random.below(grid.slices + 1));
    const uint column = random.below(grid.tiles_x + 1) * grid.tile_width;
    const uint row = random.below(grid.tiles_y + 1) * grid.tile_height;
    return {(column * double{view.ray.x} + view.ray.y) * z,
            (row * double{view.ray.z} + view.ray.w) * z, -z};
}

int within_four_ulp(Random& random) { return static_cast<int>(random.below(9)) - 4; }

// A sphere on a face, edge or corner of cells whose surface touches another of them, or a pixel.
Light touching_light(const View& view, const ClusterGrid& grid, Vec3d pixel, uint kind,
                     Random& random) {
    Vec3d center = grid_corner(view, grid, random);
    const Vec3d other = grid_corner(view, grid, random);
    // On a face or an edge of the cells rather than their corner.
    if (kind % 3 == 1) center = (center + other) * 0.5;
    if (kind % 3 == 2) center = center + random.direction() * (0.1 * length(center));
    center = rounded(center);
    double distance = length(center - pixel);
    if (kind % 4 == 0) distance = std::abs(center.z - other.z);
    if (kind % 4 == 1) distance = length(center - other);
    Light light = point_light(center, 1.0);
    light.position_range.w = nudged(std::max(distance, 1e-3), within_four_ulp(random));
    return light;
}

}  // namespace

void try_huge_ranges(const Gpu& gpu, Findings& findings) {
    Shot shot = usual_shot();
    Random random(9);
    constexpr double kScene = 60.0;
    for (int i = 0; i < 400; ++i) {
        const double range = kScene * random.log_uniform(1e3, 1e6);
        // Around the camera, beside it, behind it, and behind it by most of the range.
        Vec3d p = random.point(kScene);
        if (i % 4 == 1) p = {p.x, p.y, std::abs(p.z)};
        if (i % 4 == 2) p = {0, 0, 0.9 * range};
        if (i % 4 == 3) p = random.direction() * (0.95 * range);
        shot.lights.push_back(point_light(p, range, Vec3d{1, 1, 1} * std::max(dot(p, p), 1.0)));
    }
    const Exposure exposure = expose(gpu, shot);
    const std::uint64_t pairs = check_none_missing(findings, shot, exposure);
    findings.tried("pairs that reach", pairs, 120000);  // of 400 lights
    check_exact(findings, shot, exposure);
    std::uint64_t short_lists = 0;
    for (const ActiveCluster& c : exposure.lists.clusters) short_lists += c.list_count != 400;
    findings.none("active lists without all lights", short_lists, exposure.lists.clusters.size());
    Worst candidates;
    for (const LightExtent& e : exposure.extents) {
        const auto count = [](uint packed) {
            return double{(packed >> 16) + 1.0} - (packed & 0xffffu);
        };
        candidates.see(count(e.slices) * count(e.rows) * count(e.columns),
                       [] { return std::string(); });
    }
    findings.at_most("cells walked for a light / all cells",
                     candidates.value / exposure.grid.cluster_count, 1.0);
}

void try_spheres_at_the_camera(const Gpu& gpu, Findings& findings) {
    // Grid and pixels from 0.02 m on; spheres across z = 0 and the near plane at 0.02 m.
    ViewShape shape{64, 48};
    shape.near = 0.02;
    Shot shot = noise_shot(shape, noise_depth(0.02, 2.0, 0, 4));
    shot.request = {4, 3, 4, 0.02f, 2.0f, 0.0f};
    shot.features.light_index_bits = 32;
    Random random(11);
    for (int i = 0; i < 100000; ++i) {
        const double range = random.log_uniform(0.01, 0.6);
        const double plane = i % 2 == 0 ? 0.0 : -0.02;
        const Vec3d p{random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6),
                      plane + random.uniform(-1, 1) * range};
        shot.lights.push_back(point_light(world_from_view(shot.image.view, p), range));
    }
    const Exposure exposure = expose(gpu, shot);
    const std::uint64_t pairs = check_none_missing(findings, shot, exposure, 200);
    findings.tried("pairs that reach", pairs, 50000);
    findings.at_most("bits of lists against all lights",
                     different_bits(exposure.listed, exposure.all), 0.0);
}

void try_boundaries_and_tangents(const Gpu& gpu, Findings& findings) {
    Shot shot = usual_shot();
    const View& view = shot.image.view;
    const ClusterGrid grid = make_cluster_grid(shot.request, view.width, view.height);
    const Planes planes = planes_of(gpu, shot);
    const std::vector<uint> pixels = drawn_pixels(shot);
    Random random(12);
    for (uint i = 0; i < 3000; ++i) {
        const uint pixel = pixels[random.below(static_cast<uint>(pixels.size()))];
        shot.lights.push_back(touching_light(view, grid, point_of(planes, pixel), i, random));
    }
    check_lists(findings, gpu, shot, 50000);
}

void try_tiny_lights(const Gpu& gpu, Findings& findings) {
    // Pixels at 0.5 m and at 1 km, with a light at most of them: on the very point, or within r.
    for (const double z : {0.5, 1000.0}) {
        Shot shot = noise_shot(small_shape(), noise_depth(z, 1.1 * z, 0, 4));
        shot.request = {6, 4, 4, 0.25f, 2000.0f, 0.0f};
        const Planes planes = planes_of(gpu, shot);
        constexpr float kRanges[] = {1e-6f, 1e-3f, 1e-20f, 1e-38f, 1e-40f, 1e-45f};
        Random random(13);
        uint index = 0;
        for (const uint pixel : drawn_pixels(shot)) {
            const float range = kRanges[index % 6];
            Vec3d p = point_of(planes, pixel);
            // Towards the eye, so that the light shines, by less than the range.
            if (index++ % 2 == 0) p = rounded(p + p * (-0.5 * range / length(p)));
            Light light = point_light(p, 1.0);
            light.position_range.w = range;
            shot.lights.push_back(light);
        }
        check_lists(findings, gpu, shot, 380);
    }
    std::vector<SceneLight> lights(5);
    constexpr float kRanges[] = {0.0f, -0.0f, -1e-6f, -1.0f, 1e-40f};
    for (std::size_t i = 0; i < 5; ++i) lights[i].range = kRanges[i];
    const LightRows rows = make_light_rows(lights, glm::dvec3(0.0));
    findings.require("lights of range <= 0 rejected and counted",
                     rows.rejected == 4 && rows.local.size() == 1,
                     std::to_string(rows.rejected) + " rejected of 4");
}

void try_tangent_spheres(const Gpu& gpu, Findings& findings) {
    ViewShape shape = small_shape();
    shape.width = 33;
    shape.height = 17;
    shape.half_y = shape.half_x * 17 / 33;
    Shot shot = noise_shot(shape, noise_depth(0.5, 50.0, 0, 4));
    shot.features.light_index_bits = 32;
    shot.request = {3, 2, 4, 0.5f, 50.0f, 0.0f};
    const Planes planes = planes_of(gpu, shot);
    const std::vector<uint> pixels = drawn_pixels(shot);
    Random random(29);
    std::uint64_t missed = 0;
    std::uint64_t reaching = 0;
    constexpr uint kBatches = 5;
    constexpr uint kLights = 200000;
    for (uint batch = 0; batch < kBatches; ++batch) {
        shot.lights.clear();
        std::vector<uint> pixel_of;
        for (uint i = 0; i < kLights; ++i) {
            pixel_of.push_back(pixels[random.below(static_cast<uint>(pixels.size()))]);
            const Vec3d p = point_of(planes, pixel_of.back());
            const double wanted = random.log_uniform(1e-4, 0.3) * length(p);
            const Vec3d center = rounded(p + random.direction() * wanted);
            Light light = point_light(center, 1.0);
            light.position_range.w = nudged(length(center - p), within_four_ulp(random));
            shot.lights.push_back(light);
        }
        StageRun stages(gpu, default_tuning(gpu.info), shot.features);
        const ClusterGrid grid = make_cluster_grid(shot.request, shape.width, shape.height);
        const HostLists lists = download_lists(
            gpu, shot.features, grid,
            stages.run(upload_lights(gpu, shot.lights), upload_gbuffer(gpu, shot.image), grid));
        for (uint i = 0; i < kLights; ++i) {
            const uint x = pixel_of[i] % shape.width;
            const uint y = pixel_of[i] / shape.width;
            const float4 c = shot.lights[i].position_range;
            const Vec3d v = point_of(planes, pixel_of[i]) - Vec3d{c.x, c.y, c.z};
            if (dot(v, v) >= double{c.w} * c.w) continue;
            ++reaching;
            const uint slice = fine_slice_of_depth(grid, planes.at(SURFACE_DEPTH, x, y));
            const ActiveCluster* cluster = lists.find(fine_tile(planes.view, x, y), slice);
            const bool listed =
                cluster != nullptr && std::binary_search(lists.refined_of(*cluster).begin(),
                                                         lists.refined_of(*cluster).end(), i);
            missed += listed ? 0 : 1;
        }
    }
    findings.none("missed lights", missed, std::uint64_t{kBatches} * kLights);
    findings.tried("tangent lights that reach", reaching, 300000);
}

}  // namespace kilolux
