// SPDX-License-Identifier: Apache-2.0
// Denormal numbers, flushed to zero or not.
#include <fmt/format.h>

#include <bit>
#include <cmath>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

// Compiles evaluate.h for the host with the shading model whose lobes have long tails.
#include "kernels/shared/evaluate_modes.h"
#define SHADING SHADING_BLINN_PHONG
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"  // of other models
#include "kernels/shared/evaluate.h"
#pragma GCC diagnostic pop

#include "host/certify/cases.h"
#include "host/certify/synthetic/probe.h"
#include "host/gpu/buffer.h"
#include "host/render/lights/light_rows.h"

namespace kilolux {
namespace {

constexpr double kSmallestNormal = 0x1p-126;  // 1.2e-38
constexpr std::string_view kEvaluateHeaders[] = {
    "kernels/device/lanes.h", "kernels/shared/evaluate.h", "kernels/shared/cluster_grid.h"};
// Shades point i with all lights, and computes the slice of a depth.
constexpr std::string_view kEvaluateProbe = R"(
kernel void probe(global const float* x, global const ShadeLight* lights, uint light_count, float roughness,
                  ClusterGrid grid, global float* out, global uint* slices) {
    uint i = get_global_id(0) * VW;
    Surface s;
    s.position = fv3(lane_load(x + i), fv(0.0f), fv(-2.0f));
    s.normal = fv3(fv(0.0f), fv(0.0f), fv(1.0f));
    s.albedo = fv3(fv(0.5f), fv(0.5f), fv(0.5f));
    s.emissive = zero3();
    s.roughness = fv(roughness);
    s.metallic = fv(0.0f);
    s.occlusion = fv(1.0f);
    ShadingPoint p = make_shading_point(s, false);
    LightSum sum = zero_sum();
    for (uint k = 0; k < light_count; ++k) sum = evaluate(sum, p, lights[k]);
    lane_store(finish_shading(s, p, sum, 0.0f).x, out + i);
    lane_store(slice_of_depth(grid, lane_load(x + i) * 1e-30f), slices + i);
}
)";

struct DenormalInput {
    std::vector<float> x;
    std::vector<ShadeLight> lights;
    ClusterGrid grid{};
};

// Lights of 1e-38 and of 1, seen off the mirror direction: tails of lobes and denormal products.
DenormalInput denormal_input() {
    DenormalInput in;
    for (int i = -128; i < 128; ++i) in.x.push_back(0.05f * static_cast<float>(i));
    Random random(20);
    for (int i = 0; i < 64; ++i) {
        const float intensity = i % 4 == 3 ? 1.0f : (i % 4 == 2 ? 1e-40f : 1e-38f);
        ShadeLight light{};
        light.position_inv_range2 = {static_cast<float>(random.uniform(-3, 3)), 0.5f,
                                     static_cast<float>(random.uniform(-1.5, 0)), 1.0f / 400.0f};
        light.color_scale = {intensity, intensity, intensity, 1.0f};
        light.axis_cos.w = -1.0f;
        in.lights.push_back(light);
    }
    in.grid = make_cluster_grid({1, 1, 4, 1e-31f, 1e-28f, 0.0f}, 16, 16);
    return in;
}

struct DenormalOutput {
    std::vector<float> radiance;
    std::vector<uint> slices;
};

DenormalOutput on_device(Gpu gpu, const DenormalInput& in, int shading, bool flush) {
    BuildOptions options = BuildOptions().define("SHADING", shading);
    if (flush) options.flag("-cl-denorms-are-zero");
    cl::KernelFunctor<cl::Buffer, cl::Buffer, uint, float, ClusterGrid, cl::Buffer, cl::Buffer>
        kernel(build_probe(gpu, kEvaluateHeaders, kEvaluateProbe, options).built(), "probe");
    const cl::Buffer out = new_buffer(gpu, std::vector<float>(in.x.size()));
    const cl::Buffer slices = new_buffer(gpu, std::vector<uint>(in.x.size()));
    const auto items = in.x.size() / static_cast<std::size_t>(gpu.info.lane_width);
    kernel(cl::EnqueueArgs(gpu.queue, cl::NDRange(items)), new_buffer(gpu, in.x),
           new_buffer(gpu, in.lights), static_cast<uint>(in.lights.size()), 0.2f, in.grid, out,
           slices);
    return {download<float>(gpu, out, in.x.size()), download<uint>(gpu, slices, in.x.size())};
}

// The same functions compiled for the host, with the processor set to flush or not.
DenormalOutput on_host(const DenormalInput& in, bool flush) {
#if defined(__SSE2__)
    const unsigned before = _mm_getcsr();
    _mm_setcsr(flush ? before | 0x8040u : before & ~0x8040u);  // FTZ | DAZ
#else
    (void)flush;
#endif
    DenormalOutput out;
    for (const float x : in.x) {
        Surface s = default_surface();
        s.position = fv3(x, 0, -2);
        s.albedo = fv3(0.5f, 0.5f, 0.5f);
        s.roughness = 0.2f;
        const ShadingPoint p = make_shading_point(s, false);
        LightSum sum = zero_sum();
        for (const ShadeLight& light : in.lights) sum = evaluate(sum, p, light);
        out.radiance.push_back(finish_shading(s, p, sum, 0.0f).x);
        out.slices.push_back(slice_of_depth(in.grid, x * 1e-30f));
    }
#if defined(__SSE2__)
    _mm_setcsr(before);
#endif
    return out;
}

void compare(Findings& findings, const DenormalOutput& a, const DenormalOutput& b, double k) {
    Worst radiance;
    std::uint64_t slices = 0;
    for (std::size_t i = 0; i < a.radiance.size(); ++i) {
        radiance.add(std::abs(double{a.radiance[i]} - b.radiance[i]) / (kSmallestNormal * k),
                     [&] { return fmt::to_string(i); });
        slices += a.slices[i] != b.slices[i] ? 1 : 0;
    }
    findings.at_most("flushed against not: |d| / (1.2e-38 k)", radiance, 1.0);
    findings.none("slices that differ", slices, a.slices.size());
}

}  // namespace

void try_denormals(const Gpu& gpu, Findings& findings) {
    const DenormalInput in = denormal_input();
    const auto k = static_cast<double>(in.lights.size());
    for (const int shading : {SHADING_LAMBERT, SHADING_BLINN_PHONG}) {
        compare(findings, on_device(gpu, in, shading, false), on_device(gpu, in, shading, true), k);
    }
    compare(findings, on_host(in, false), on_host(in, true), k);
    // Lights of 1e-38 are listed, and the lists give the picture of all lights.
    LightingCase input = noise_case({33, 17}, noise_depth(0.5, 20.0, 0.1, 4));
    input.lights = random_lights(input.image.view, {.count = 300});
    for (Light& light : input.lights) light.color_scale = {1e-38f, 2e-39f, 1e-40f, 1.0f};
    check_lists(findings, gpu, input, 300);
    const std::vector<SceneLight> dim(1, {.intensity = glm::vec3(1e-38f), .range = 1.0f});
    findings.require("a light of 1e-38 is kept", make_light_rows(dim, {}).rejected == 0);
    // Slices begin far from denormals: z_first is at least 2^-100.
    const ClusterGrid lowest = make_cluster_grid({1, 1, 1, 1e-45f, 1.0f, 0.0f}, 16, 16);
    findings.require("z_first >= 2^-100", std::bit_cast<float>(lowest.z_first_bits) >= 0x1p-100f);
}

}  // namespace kilolux
