// SPDX-License-Identifier: Apache-2.0
// Depth slices: boundaries, huge ratios of far to near, and what lies beyond the grid.
#include <algorithm>
#include <array>
#include <bit>

#include "host/certify/cases.h"
#include "host/certify/shot.h"
#include "host/certify/synthetic/probe.h"
#include "host/gpu/buffer.h"
#include "host/scene/camera.h"
#include "raster/compute_probe.h"
#include "raster/gl_context.h"

namespace kilolux {
namespace {

// --- 1: slices are the same everywhere ---

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

std::vector<uint> slices_of_device(Gpu gpu, const ClusterGrid& grid, std::vector<float> z) {
    const std::size_t count = z.size();
    z.resize(round_up(count, 16), 1.0f);
    const cl::Buffer out = new_buffer(gpu, std::vector<uint>(z.size(), ~0u));
    cl::KernelFunctor<ClusterGrid, cl::Buffer, cl::Buffer> kernel(
        build_probe(gpu, kSliceHeaders, kSliceProbe), "probe");
    const auto lanes = static_cast<std::size_t>(gpu.info.lane_width);
    kernel(cl::EnqueueArgs(gpu.queue, cl::NDRange(z.size() / lanes)), grid, new_buffer(gpu, z),
           out);
    return download<uint>(gpu, out, count);
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

// By the slices' ends alone, without bit tricks.
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
    std::uint64_t different = 0;
    std::string where;
    for (std::size_t i = 0; i < z.size(); ++i) {
        if (found[i] == expected[i]) continue;
        if (different++ == 0) where = "z = " + std::to_string(z[i]);
    }
    findings.none(what, different, z.size(), where);
}

// --- 2, 3: images of slabs at a depth each ---

double tile_noise(uint x, uint y) {
    const uint h = (x / FINE_TILE * 73u + y / FINE_TILE * 151u + 7u) * 2654435761u;
    return (h >> 8) * 0x1p-24;
}

// Every tile at its own depth in [near, far], slanted by a tenth of it.
DepthOf slab_depth(double near, double far) {
    return [=](uint x, uint y) {
        const double slant = 1.0 + 0.1 * (x % FINE_TILE + y % FINE_TILE) / 32.0;
        return std::min(near * std::pow(far / near, tile_noise(x, y)) * slant, far * 0.999);
    };
}

struct DeepShot {
    Shot shot;
    Worst depth_error;  // of the reconstructed z, relative
};

Camera deep_camera(double near, double far) {
    Camera camera;
    camera.z_near = near;
    camera.z_far = far;
    return camera;
}

// Depth buffer values as a camera in double gives them, rounded to float once.
void draw_depths(Shot& shot, const Camera& camera, const DepthOf& depth) {
    const View& view = shot.image.view;
    const double inverse_far = 1.0 / camera.z_far;
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.width; ++x) {
            const double d =
                (1.0 / depth(x, y) - inverse_far) / (1.0 / camera.z_near - inverse_far);
            shot.image.plane<float>(PLANE_DEPTH)[y * view.stride + x] = static_cast<float>(d);
        }
    }
}

Shot deep_shot(double near, double far, const DepthOf& depth) {
    const Camera camera = deep_camera(near, far);
    Shot shot;
    const View view = view_of(camera, 129, 97);
    shot.image = make_synthetic(view, {}, depth);
    draw_depths(shot, camera, depth);
    shot.request = {8, 6, 4, static_cast<float>(near), static_cast<float>(far), 0.0f};
    Random random(3);
    constexpr int kLights = 1500;
    for (int i = 0; i < kLights; ++i) {
        const double z = near * std::pow(far / near, (i + random.unit()) / kLights);
        const Vec3d p{random.uniform(0, 129) * view.ray.x + view.ray.y,
                      random.uniform(0, 97) * view.ray.z + view.ray.w, -1.0};
        shot.lights.push_back(point_light(p * z, 0.4 * z, Vec3d{1, 2, 3} * (z * z)));
    }
    return shot;
}

double useful_share(const Shot& shot, const Exposure& exposure) {
    const LightsPerPixel k = lights_per_pixel(shot, exposure);
    return k.reaching / k.listed;
}

}  // namespace

void try_slice_boundaries(const Gpu& gpu, Findings& findings) {
    const GlContext context = GlContext::headless();
    const GlProgram glsl = compute_program({"kernels/shared/cluster_grid.h"}, kSliceGlsl);
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
        const GlBuffer grid_buffer = storage_buffer(2, &grid, sizeof(grid));
        compare_slices(findings, "GLSL", run_compute<uint>(glsl, z), expected, z);
    }
}

void try_far_over_near(const Gpu& gpu, Findings& findings) {
    const auto try_one = [&](double near, double far) {
        const DepthOf depth = slab_depth(near, far);
        const Shot shot = deep_shot(near, far, depth);
        const Exposure exposure = expose(gpu, shot);
        const std::uint64_t pairs = check_none_missing(findings, shot, exposure);
        findings.tried("pairs that reach", pairs, 500);
        check_exact(findings, shot, exposure);
        Worst error;
        for (uint y = 0; y < 97; ++y) {
            for (uint x = 0; x < 129; ++x) {
                const double found = exposure.planes.at(SURFACE_DEPTH, x, y);
                error.see(std::abs(found / depth(x, y) - 1.0), [&] { return at_pixel(x, y); });
            }
        }
        // u each for the depth value, its coefficient, the fma and the division: 4 * 6e-8.
        findings.at_most("relative error of z", error, 2.5e-7);
        return useful_share(shot, exposure);
    };
    const double usual = try_one(0.1, 100.0);
    for (const double share : {try_one(1e-3, 1e4), try_one(0.1, 1e6)}) {
        findings.at_most("share of k*/k lost against far/near 1e3", 1.0 - share / usual, 0.5);
    }
}

void try_beyond_the_grid(const Gpu& gpu, Findings& findings) {
    // The grid spans 1..10 m; pixels lie at 0.05..0.9 m and 11..5000 m, and so do the lights.
    for (const auto& [near, far] : {std::array{0.05, 0.9}, std::array{11.0, 5000.0}}) {
        Shot shot = deep_shot(0.02, std::numeric_limits<double>::infinity(), slab_depth(near, far));
        shot.request = {8, 6, 4, 1.0f, 10.0f, 0.0f};
        LightMix mix;
        mix.count = 800;
        mix.z_near = near;
        mix.z_far = far;
        mix.range_min = 0.05 * near;
        mix.range_max = 0.2 * far;
        shot.lights = random_lights(shot.image.view, mix);
        check_lists(findings, gpu, shot);
    }
}

}  // namespace kilolux
