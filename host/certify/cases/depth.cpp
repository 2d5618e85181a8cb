// SPDX-License-Identifier: Apache-2.0
// Depth slices: boundaries, huge ratios of far to near, and what lies beyond the grid.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

#include "host/certify/cases.h"
#include "host/certify/opengl_beside.h"
#include "host/certify/synthetic/run_probe.h"
#include "host/gpu/buffer.h"
#include "host/scene/camera.h"
#include "raster/compute_probe.h"

namespace kilolux {
namespace {

// Case 1, slice-boundaries.

constexpr std::string_view kSliceHeaders[] = {"kernels/device/lanes.h",
                                              "kernels/shared/cluster_grid.h"};
constexpr std::string_view kSliceProbe = R"(
kernel void probe(ClusterGrid grid, global const float* z, global uint* out) {
    size_t first = get_global_id(0) * VW;
    lane_store(slice_of_depth(grid, lane_load(z + first)), out + first);
}
)";
constexpr const char* kSliceGlsl = R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer In { float z[]; };
layout(std430, binding = 1) buffer Out { uint slice[]; };
layout(std430, binding = 2) buffer Grid { ClusterGrid grid; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < z.length()) slice[i] = slice_of_depth(grid, z[i]);
}
)";

std::vector<uint> slices_of_device(const Gpu& gpu, const ClusterGrid& grid, std::vector<float> z) {
    const std::size_t count = z.size();
    z.resize(round_up(count, 16), 1.0f);
    auto slices = run_probe<uint>(gpu, {kSliceHeaders, kSliceProbe}, z.size() / lanes_of(gpu),
                                  z.size(), grid, z);
    slices.resize(count);
    return slices;
}

std::vector<float> depths_to_slice(const ClusterGrid& grid, bool random_ones) {
    std::vector<float> z = {
        0.0f, -0.0f, -1.0f, -1e30f, 1e-40f, 1e30f, std::numeric_limits<float>::infinity()};
    for (uint slice = 0; slice <= grid.slices; ++slice) {
        const uint bits = std::bit_cast<uint>(depth_of_slice(grid, slice));
        for (uint ulp = 0; ulp <= 400; ++ulp) z.push_back(std::bit_cast<float>(bits - 200 + ulp));
    }
    Random random(5);
    for (int i = 0; random_ones && i < 1000000; ++i) {
        z.push_back(static_cast<float>(random.log_uniform(1e-4, 1e5)));
    }
    return z;
}

// By comparing with the ends of the slices.
std::vector<uint> slices_by_search(const ClusterGrid& grid, const std::vector<float>& z) {
    std::vector<float> ends;
    for (uint slice = 1; slice < grid.slices; ++slice) ends.push_back(depth_of_slice(grid, slice));
    std::vector<uint> out;
    for (const float depth : z) {
        const auto above = std::upper_bound(ends.begin(), ends.end(), depth);
        out.push_back(static_cast<uint>(above - ends.begin()));
    }
    return out;
}

void compare_slices(Findings& findings, std::string_view what, const std::vector<uint>& found,
                    const std::vector<uint>& expected, const std::vector<float>& z) {
    Worst different;
    for (std::size_t i = 0; i < z.size(); ++i) {
        if (found[i] == expected[i]) continue;
        if (different.value++ == 0.0) different.where = fmt::format("z = {:f}", z[i]);
    }
    different.checked = z.size();
    findings.at_most(what, different, 0.0);
}

// Cases 2, far-over-near, and 3, beyond-the-grid.

double tile_noise(uint x, uint y) {
    const uint h = (x / FINE_TILE * 73u + y / FINE_TILE * 151u + 7u) * 2654435761u;
    return (h >> 8) * 0x1p-24;
}

// Every tile has its own depth in [near, far], and slants by a tenth of it.
DepthOf slab_depth(double near, double far) {
    return [=](uint x, uint y) {
        const double slant = 1.0 + 0.1 * (x % FINE_TILE + y % FINE_TILE) / 32.0;
        return std::min(near * std::pow(far / near, tile_noise(x, y)) * slant, far * 0.999);
    };
}

// Depth buffer values as a camera in double gives them, rounded to float once.
void draw_depths(LightingCase& input, const Camera& camera, const DepthOf& depth) {
    const View& view = input.image.view;
    const double inverse_far = 1.0 / camera.z_far;
    for_each_pixel(view, [&](uint x, uint y) {
        const double d = (1.0 / depth(x, y) - inverse_far) / (1.0 / camera.z_near - inverse_far);
        input.image.put(PLANE_DEPTH, std::size_t{y} * view.stride + x, d);
    });
}

LightingCase deep_case(double near, double far, const DepthOf& depth) {
    Camera camera;
    camera.z_near = near;
    camera.z_far = far;
    LightingCase input;
    const View view = view_of(camera, 129, 97);
    input.image = make_synthetic(view, {}, depth);
    draw_depths(input, camera, depth);
    input.request = {8, 6, 4, static_cast<float>(near), static_cast<float>(far), 0.0f};
    Random random(3);
    constexpr int kLights = 1500;
    for (int i = 0; i < kLights; ++i) {
        const double z = near * std::pow(far / near, (i + random.unit()) / kLights);
        const double px = random.uniform(0, 129);
        const glm::dvec3 p = position_at(view, px, random.uniform(0, 97), z);
        input.lights.push_back(point_light(p, 0.4 * z, glm::dvec3(1, 2, 3) * (z * z)));
    }
    return input;
}

}  // namespace

void try_slice_boundaries(const Gpu& gpu, Findings& findings) {
    const std::optional<GlContext> context = opengl_beside(findings);
    std::optional<GlProgram> glsl;
    if (context) glsl = compute_program({"kernels/shared/cluster_grid.h"}, kSliceGlsl);
    bool first = true;
    for (const GridRequest& request :
         {GridRequest{16, 9, 4, 0.1f, 1000.0f, 0.0f}, GridRequest{4, 4, 64, 0.3f, 1e7f, 0.0f},
          GridRequest{1, 1, 2, 1e-30f, 1e30f, 0.0f}, GridRequest{1, 1, 8, 5.0f, 5.0f, 0.0f},
          GridRequest{3, 3, 3, 0.1f, 1000.0f, 0.0f}, GridRequest{4, 4, 63, 0.3f, 1e3f, 0.0f}}) {
        const ClusterGrid grid = make_cluster_grid(request, 640, 480);
        const std::vector<float> z = depths_to_slice(grid, first);
        first = false;
        const std::vector<uint> expected = slices_by_search(grid, z);
        std::vector<uint> host;
        for (const float depth : z) host.push_back(slice_of_depth(grid, depth));
        compare_slices(findings, "slices that differ: C++", host, expected, z);
        compare_slices(findings, "OpenCL", slices_of_device(gpu, grid, z), expected, z);
        if (!glsl) continue;
        const GlBuffer grid_buffer = storage_buffer(2, &grid, sizeof(grid));
        compare_slices(findings, "GLSL", run_compute<uint>(*glsl, z), expected, z);
    }
}

void try_far_over_near(const Gpu& gpu, Findings& findings) {
    const auto try_one = [&](double near, double far) {
        const DepthOf depth = slab_depth(near, far);
        const LightingCase input = deep_case(near, far, depth);
        const DeviceResult result = check_lists(findings, gpu, input, 500);
        const Worst error = worst_of_drawn(input, [&](uint x, uint y) {
            return std::abs(result.planes.at(SURFACE_DEPTH, x, y) / depth(x, y) - 1.0);
        });
        // u each for the depth value, its coefficient, the fma and the division: 4 * 6e-8.
        findings.at_most("relative error of z", error, 2.5e-7);
        return useful_share(input, result);
    };
    const double usual = try_one(0.1, 100.0);
    for (const double share : {try_one(1e-3, 1e4), try_one(0.1, 1e6)}) {
        findings.at_most("share of k*/k lost against far/near 1e3", 1.0 - share / usual, 0.5);
    }
}

void try_beyond_the_grid(const Gpu& gpu, Findings& findings) {
    // The grid spans 1..10 m; pixels lie at 0.05..0.9 m and 11..5000 m, and so do the lights.
    for (const auto& [near, far] : {std::array{0.05, 0.9}, std::array{11.0, 5000.0}}) {
        LightingCase input =
            deep_case(0.02, std::numeric_limits<double>::infinity(), slab_depth(near, far));
        input.request = {8, 6, 4, 1.0f, 10.0f, 0.0f};
        input.lights = random_lights(input.image.view, {.count = 800,
                                                        .z_near = near,
                                                        .z_far = far,
                                                        .range_min = 0.05 * near,
                                                        .range_max = 0.2 * far});
        check_lists(findings, gpu, input);
    }
}

}  // namespace kilolux
