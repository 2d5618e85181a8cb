// SPDX-License-Identifier: Apache-2.0
// Metamorphic tests: what a change of the input must do to the picture, without any reference.
#include <algorithm>
#include <bit>
#include <cmath>

#include "host/certify/cases.h"
#include "host/certify/shot.h"
#include "host/certify/synthetic/probe.h"
#include "kernels/shared/evaluate_modes.h"

namespace kilolux {
namespace {

constexpr int kSumBlock = 64;     // lights of a block of the sum: SUM_BLOCK_LOG2
constexpr double kUlp = 0x1p-24;  // u: half a unit in the last place of 1

Shot usual_shot(int shading, uint light_count) {
    ViewShape shape{67, 35};
    shape.half_y = shape.half_x * 35 / 67;
    Shot shot = noise_shot(shape, noise_depth(0.4, 50.0, 0.1, 8), every_feature(shading));
    LightMix mix;
    mix.count = light_count;
    mix.spots = 0.4;
    shot.lights = random_lights(shot.image.view, mix);
    shot.suns = {{{0.48f, 0.6f, 0.64f, 0.0f}, {0.5f, 0.6f, 0.7f, 0.0f}}};
    shot.ambient = 0.05f;
    return shot;
}

void scale_color(float4& color, int exponent) {
    color.x = std::ldexp(color.x, exponent);
    color.y = std::ldexp(color.y, exponent);
    color.z = std::ldexp(color.z, exponent);
}

void scale_intensities(Shot& shot, int exponent) {
    for (Light& light : shot.lights) scale_color(light.color_scale, exponent);
    for (DirectionalLight& sun : shot.suns) scale_color(sun.color, exponent);
}

std::uint64_t lit_values(const Exposure& e) {
    return static_cast<std::uint64_t>(
        std::count_if(e.listed.begin(), e.listed.end(), [](float v) { return v > 1e-3f; }));
}

// Distance in floats of two numbers that are not negative.
double ulps_apart(float a, float b) {
    return std::abs(static_cast<double>(std::bit_cast<int>(a)) - std::bit_cast<int>(b));
}

// The world and its radii times 2^exponent.
Shot scaled_world(Shot shot, int exponent) {
    const auto scale = [&](float v) { return std::ldexp(v, exponent); };
    for (Light& light : shot.lights) {
        float4& p = light.position_range;
        p = {scale(p.x), scale(p.y), scale(p.z), scale(p.w)};
        scale_color(light.color_scale, 2 * exponent);
    }
    // 1/z = depth01 * depth.x: the depth buffer stays as it is.
    float4& depth = shot.image.view.depth;
    depth = {std::ldexp(depth.x, -exponent), std::ldexp(depth.y, -exponent),
             std::ldexp(depth.z, -exponent), std::ldexp(depth.w, -exponent)};
    shot.request.z_first = scale(shot.request.z_first);
    shot.request.z_last = scale(shot.request.z_last);
    return shot;
}

// Without lights nearer to a pixel than `least`: the 1 cm within which the inverse square stops
// growing is a length of its own, and does not scale.
void remove_near_lights(const Gpu& gpu, Shot& shot, double least) {
    const Planes planes = decode(gpu, shot.features, upload_gbuffer(gpu, shot.image));
    const View& view = shot.image.view;
    std::erase_if(shot.lights, [&](const Light& light) {
        const float4 c = light.position_range;
        const Vec3d p = view_from_world(view, {c.x, c.y, c.z});
        for (uint i = 0; i < view.width * view.height; ++i) {
            const uint x = i % view.width;
            const uint y = i / view.width;
            if (length(planes.vector(SURFACE_POSITION, x, y) - p) < least) return true;
        }
        return false;
    });
}

// --- mirror ---

std::vector<SurfaceSample> random_surfaces(uint width, uint height) {
    std::vector<SurfaceSample> surfaces;
    Random random(5);
    for (uint i = 0; i < width * height; ++i) {
        SurfaceSample s;
        const double z = random.log_uniform(1.0, 8.0);
        s.position = {random.uniform(-0.8, 0.8) * z, random.uniform(-0.6, 0.6) * z, -z};
        const Vec3d n = random.direction();
        s.normal = {n.x, n.y, std::abs(n.z)};
        s.albedo = {random.unit(), random.unit(), random.unit()};
        s.roughness = random.uniform(0.1, 1.0);
        s.metallic = random.below(2);
        s.kind = SurfaceKind::lit;
        surfaces.push_back(s);
    }
    return surfaces;
}

constexpr uint kMirrorWidth = 64;

std::vector<SurfaceSample> mirrored(const std::vector<SurfaceSample>& surfaces) {
    std::vector<SurfaceSample> out = surfaces;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const std::size_t x = i % kMirrorWidth;
        SurfaceSample s = surfaces[i];
        s.position.x = -s.position.x;
        s.normal.x = -s.normal.x;
        out[i - x + (kMirrorWidth - 1 - x)] = s;
    }
    return out;
}

}  // namespace

void try_other_grids(const Gpu& gpu, Findings& findings) {
    Shot shot = usual_shot(SHADING_PBR, 500);
    const Exposure expected = expose(gpu, shot);
    findings.tried("lit values", lit_values(expected), 1000);
    for (const GridRequest& request :
         {GridRequest{1, 1, 1, 0.1f, 0.1f, 0.0f}, GridRequest{64, 64, 64, 0.01f, 1e4f, 0.0f},
          GridRequest{3, 5, 2, 5.0f, 9.0f, 0.0f}, GridRequest{2, 1, 8, 0.3f, 60.0f, 0.0f, 64},
          GridRequest{3, 3, 3, 0.2f, 80.0f, 0.0f}}) {
        shot.request = request;
        findings.at_most("bits changed by the grid",
                         different_bits(expose(gpu, shot).listed, expected.listed), 0.0);
    }
}

void try_idle_lights(const Gpu& gpu, Findings& findings) {
    Shot shot = usual_shot(SHADING_PBR, 300);
    const Exposure expected = expose(gpu, shot);
    findings.tried("lit values", lit_values(expected), 1000);
    const auto idle_light = [](int i) {
        return i % 2 == 0 ? point_light({0, 0, 0}, 100.0, {0, 0, 0})
                          : point_light({1e6, 0, 0}, 10.0);
    };
    // Two blocks of the sum between others, which shifts lists but no block; and more at the end.
    std::vector<Light> blocks;
    for (int i = 0; i < 2 * kSumBlock; ++i) blocks.push_back(idle_light(i));
    shot.lights.insert(shot.lights.begin() + kSumBlock, blocks.begin(), blocks.end());
    for (int i = 0; i < 372; ++i) shot.lights.push_back(idle_light(i));
    findings.at_most("bits changed by idle lights",
                     different_bits(expose(gpu, shot).listed, expected.listed), 0.0);
}

void try_scaled_intensities(const Gpu& gpu, Findings& findings) {
    for (const int shading : {SHADING_LAMBERT, SHADING_BLINN_PHONG, SHADING_PBR}) {
        Shot shot = usual_shot(shading, 200);
        put_out_surfaces(shot);
        const Exposure expected = expose(gpu, shot);
        findings.tried("lit values", lit_values(expected), 1000);
        for (const int exponent : {-24, -3, 1, 30}) {
            Shot scaled = shot;
            scale_intensities(scaled, exponent);
            std::vector<float> product = expected.listed;
            for (float& v : product) v = std::ldexp(v, exponent);
            findings.at_most("bits that are not the product's",
                             different_bits(expose(gpu, scaled).listed, product), 0.0);
        }
    }
}

void try_scaled_worlds(const Gpu& gpu, Findings& findings) {
    for (const int shading : {SHADING_LAMBERT, SHADING_PBR}) {
        Shot shot = usual_shot(shading, 300);
        constexpr int kMost = 5;
        remove_near_lights(gpu, shot, 0.0101 * (1 << kMost));
        const Exposure expected = expose(gpu, shot);
        findings.tried("lit values", lit_values(expected), 1000);
        findings.tried("lights left", shot.lights.size(), 100);
        for (const int exponent : {-kMost, -1, 3, 10}) {
            findings.at_most(
                "bits changed by scale",
                different_bits(expose(gpu, scaled_world(shot, exponent)).listed, expected.listed),
                0.0);
        }
    }
}

void try_mirror(const Gpu& gpu, Findings& findings) {
    const std::vector<SurfaceSample> surfaces = random_surfaces(kMirrorWidth, 24);
    Shot shot = surface_shot(surfaces, SHADING_PBR, kMirrorWidth);
    Shot other = surface_shot(mirrored(surfaces), SHADING_PBR, kMirrorWidth);
    LightMix mix;
    mix.count = 300;
    mix.spots = 0.4;
    mix.z_far = 10.0;
    mix.range_min = 0.5;
    shot.lights = other.lights = random_lights(shot.image.view, mix);
    for (Light& light : other.lights) {
        light.position_range.x = -light.position_range.x;
        light.axis_cos.x = -light.axis_cos.x;
    }
    const Exposure a = expose(gpu, shot);
    const Exposure b = expose(gpu, other);
    findings.tried("lit values", lit_values(a), 1000);
    Worst worst;
    for (std::size_t i = 0; i < a.listed.size(); ++i) {
        const std::size_t x = i % kMirrorWidth;
        worst.see(ulps_apart(a.listed[i], b.listed[i - x + (kMirrorWidth - 1 - x)]),
                  [&] { return "value " + std::to_string(i); });
    }
    findings.at_most("ulp apart", worst, 2.0);
}

void try_split_light(const Gpu& gpu, Findings& findings) {
    for (const int shading : {SHADING_LAMBERT, SHADING_PBR}) {
        Shot shot = usual_shot(shading, 200);
        put_out_surfaces(shot);
        const Exposure expected = expose(gpu, shot);
        for (const std::size_t split : {std::size_t{0}, std::size_t{63}, std::size_t{150}}) {
            Shot halves = shot;
            scale_color(halves.lights[split].color_scale, -1);
            halves.lights.insert(halves.lights.begin() + static_cast<std::ptrdiff_t>(split),
                                 halves.lights[split]);
            const Exposure found = expose(gpu, halves);
            const double k = static_cast<double>(halves.lights.size() + halves.suns.size());
            Worst worst;
            for (std::size_t i = 0; i < found.listed.size(); ++i) {
                worst.see(ulps_apart(found.listed[i], expected.listed[i]) / (2.0 * k),
                          [&] { return "value " + std::to_string(i); });
            }
            findings.at_most("ulp apart / 2k", worst, 1.0);
        }
        findings.tried("lit values", lit_values(expected), 1000);
    }
}

void try_permuted_lights(const Gpu& gpu, Findings& findings) {
    Shot shot = usual_shot(SHADING_LAMBERT, 1000);
    shot.ambient = 0.0f;
    const Exposure expected = expose(gpu, shot);
    const ReferencePicture r1 = r1_picture(shot, expected);
    const View& view = shot.image.view;
    const std::size_t plane = std::size_t{view.stride} * view.height;
    std::mt19937 random(7);
    for (int order = 0; order < 3; ++order) {
        std::shuffle(shot.lights.begin(), shot.lights.end(), random);
        const Exposure found = expose(gpu, shot);
        Worst worst;
        for (uint y = 0; y < view.height; ++y) {
            for (uint x = 0; x < view.width; ++x) {
                for (std::size_t c = 0; c < 3; ++c) {
                    const std::size_t i = c * plane + std::size_t{y} * view.stride + x;
                    const std::size_t at = 3 * (std::size_t{y} * view.width + x) + c;
                    const double scale = std::max(r1.scale.rgb[at], r1.radiance.rgb[at]);
                    const double apart = std::abs(double{found.listed[i]} - expected.listed[i]);
                    // Both orders are within the bound of case 18 of the true sum.
                    const double bound = 2.0 * (72.0 + 1001.0 / 64.0) * kUlp * scale;
                    if (scale > 0.0) worst.see(apart / bound, [&] { return at_pixel(x, y); });
                }
            }
        }
        findings.at_most("apart / bound", worst, 1.0);
    }
    findings.tried("lit values", lit_values(expected), 1000);
}

void try_lane_widths(const Gpu& gpu, Findings& findings) {
    const Gpu one = gpu.with_lanes(1);
    for (const int shading : {SHADING_LAMBERT, SHADING_BLINN_PHONG, SHADING_PBR}) {
        const Shot shot = usual_shot(shading, 500);
        const Exposure expected = expose(one, shot);
        const Exposure found = expose(gpu, shot);
        findings.at_most("bits that differ from one lane's",
                         different_bits(found.listed, expected.listed), 0.0);
        findings.at_most("bits of all lights", different_bits(found.all, expected.all), 0.0);
        findings.require("the same lists", fingerprint(found.lists) == fingerprint(expected.lists));
        findings.at_most("bits of surfaces",
                         different_bits(found.planes.values, expected.planes.values), 0.0);
        findings.tried("lit values", lit_values(expected), 1000);
    }
}

}  // namespace kilolux
