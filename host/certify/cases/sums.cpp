// SPDX-License-Identifier: Apache-2.0
// What a light adds at a point, and sums over many of them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/base/formats/half.h"
#include "host/certify/cases.h"
#include "kernels/shared/evaluate_modes.h"

namespace kilolux {
namespace {

constexpr int kShadings[] = {SHADING_LAMBERT, SHADING_BLINN_PHONG, SHADING_PBR};
constexpr double kNearest = 0.01;  // LIGHT_D_MIN [m]

Light light_at(const glm::dvec3& position, double range, double intensity) {
    return point_light(position, range, glm::dvec3(1, 0.5, 0.25) * intensity);
}

// Surfaces on the axis, half a metre apart, each with a light that reaches no other. On the axis x
// and y are 0, so float32 positions hold any distance from it, down to 1e-30 m.
LightingCase near_lights_case(int shading) {
    std::vector<SurfaceSample> surfaces;
    std::vector<Light> lights;
    const glm::dvec3 directions[] = {{1, 0, 0}, {0.6, 0.8, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const double d :
         {0.0, 1e-30, 1e-20, 1e-10, 1e-7, 1e-5, 1e-4, 1e-3, 9.9e-3, 0.01, 0.0101}) {
        for (const glm::dvec3& direction : directions) {
            const glm::dvec3 p(0, 0, -1.0 - 0.5 * static_cast<double>(surfaces.size()));
            surfaces.push_back(grey_surface(p, glm::normalize(glm::dvec3(0.3, 0.2, 1.0))));
            lights.push_back(light_at(p + d * direction, 0.4, 1.0));
        }
    }
    LightingCase input = surface_case(surfaces, shading);
    input.lights = lights;
    return input;
}

// Case 14, half-overflow.

LightingCase overlapping_case(int shading, double intensity) {
    std::vector<SurfaceSample> surfaces;
    Random random(14);
    for (int i = 0; i < 32; ++i) {
        const double z = random.uniform(2, 6);
        surfaces.push_back(
            grey_surface({z * random.uniform(-0.5, 0.5), z * random.uniform(-0.5, 0.5), -z}));
    }
    LightingCase input = surface_case(surfaces, shading);
    for (int i = 0; i < 1000; ++i) {
        input.lights.push_back(light_at(random.point(5.0), 50.0, intensity));
    }
    return input;
}

// Case 18, long-sums.

// Lights all around a point; intensities from e^-6 to e^6.
std::vector<Light> lights_of_all_sizes(uint count) {
    Random random(18);
    std::vector<Light> lights;
    lights.reserve(count);
    for (uint i = 0; i < count; ++i) {
        const glm::dvec3 p{random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-2.5, 1)};
        lights.push_back(light_at(p, 60.0, std::exp(random.uniform(-6, 6))));
    }
    return lights;
}

// Lights are summed in blocks of 64: 64 u within a block, k/64 u over the blocks, 8 u for a term.
double sum_bound(double k) { return (64.0 + k / 64.0 + 8.0) * kUlp; }

void check_sum(Findings& findings, const Gpu& gpu, const LightingCase& input) {
    const DeviceResult result = light_on_device(gpu, input);
    const double bound = sum_bound(static_cast<double>(input.lights.size()));
    const Worst worst = error_against_r1(input, result);
    findings.at_most(
        "|x-r|/E / ((72 + k/64) u)",
        Worst{worst.value / bound, worst.checked, fmt::format("{} lights", input.lights.size())},
        1.0);
    if (input.lights.size() == 1000000) findings.report("|x-r|/E of 1e6 lights", worst.value);
    if (input.lights.size() == 1000) findings.report("|x-r|/E of 1000 lights", worst.value);
    check_exact(findings, input, result);
}

LightingCase sum_case(uint count) {
    const SurfaceSample floor = grey_surface({0.25, -0.125, -4.0});
    LightingCase input = surface_case(std::span(&floor, 1), SHADING_LAMBERT);
    input.request.tiles_x = input.request.tiles_y = input.request.slices_per_octave = 1;
    input.lights = lights_of_all_sizes(count);
    return input;
}

// Case 22, narrow-lobes.

// Normals that sweep away from the half vector by up to `widths` widths of the lobe; eye and light
// straight above.
std::vector<SurfaceSample> lobe_sweep(double roughness, double widths) {
    std::vector<SurfaceSample> surfaces;
    const double r = std::max(roughness, 0.045);
    for (int i = -120; i <= 120; ++i) {
        const double angle = std::min(widths * r * r, 1.5) * i / 120.0;
        SurfaceSample s = grey_surface({0, 0, -3}, {std::sin(angle), 0, std::cos(angle)});
        s.roughness = roughness;
        s.metallic = 1;
        s.albedo = glm::dvec3(1);
        surfaces.push_back(s);
    }
    return surfaces;
}

void check_lobe(Findings& findings, const Gpu& gpu, int shading, double roughness, double limit) {
    LightingCase input = surface_case(lobe_sweep(roughness, 4.0), shading, 64);
    input.lights = {light_at({1e-3, 0, 0}, 50.0, 1.0)};
    const DeviceResult result = light_on_device(gpu, input);
    const ReferencePicture r1 = r1_picture(input, result);
    const double peak = *std::max_element(r1.radiance.rgb.begin(), r1.radiance.rgb.end());
    const auto place = [&] { return fmt::format("roughness {:f}", roughness); };
    Worst worst;
    Worst above;
    std::size_t i = 0;
    for_each_pixel(input.image.view, [&](uint x, uint y) {
        const double found = result.radiance(x, y, 0);
        worst.add(std::abs(found - r1.radiance.rgb[3 * i++]) / peak, place);
        above.add(found / peak - 1.0, place);
    });
    const bool phong = shading == SHADING_BLINN_PHONG;
    findings.at_most(phong ? "Blinn-Phong: error / peak" : "GGX: error / peak", worst, limit);
    findings.at_most("above the peak, relative", above, 1e-5);
    check_exact(findings, input, result);
}

// Roughness whose exponent 2/alpha^2 - 2 is n.
double roughness_of(double exponent) { return std::pow(2.0 / (exponent + 2.0), 0.25); }

}  // namespace

void try_light_at_the_point(const Gpu& gpu, Findings& findings) {
    for (const int shading : kShadings) {
        const LightingCase input = near_lights_case(shading);
        const DeviceResult result = light_on_device(gpu, input);
        findings.at_most("|d|/max(r,E) against R1", error_against_r1(input, result), 1e-5);
        check_exact(findings, input, result);
        if (shading != SHADING_LAMBERT) continue;
        // A white surface reflects at most I / (pi d_min^2); the albedo here is 0.5.
        const float most = *std::max_element(result.listed.begin(), result.listed.end());
        findings.at_most("radiance / (I / d_min^2)", most * kNearest * kNearest, 1.0);
    }
}

void try_half_overflow(const Gpu& gpu, Findings& findings) {
    for (const int shading : {SHADING_LAMBERT, SHADING_PBR}) {
        for (const double intensity : {1e6, 1e12, 1e20, 1e30}) {
            const LightingCase input = overlapping_case(shading, intensity);
            const DeviceResult result = light_on_device(gpu, input);
            findings.at_most("|d|/max(r,E) against R1", error_against_r1(input, result), 1e-5);
            check_exact(findings, input, result);
            std::uint64_t wrong = 0;
            for (const float v : result.listed) {
                const double narrow = half_value(half_bits_clamped(v));
                wrong += narrow <= kHalfMax && (v < kHalfMax || narrow == kHalfMax) ? 0 : 1;
            }
            findings.none("halves not clamped to 65504", wrong, result.listed.size());
        }
    }
}

void try_long_sums(const Gpu& gpu, Findings& findings) {
    for (const uint count : {1u, 2u, 63u, 64u, 65u, 1000u, 10000u, 100000u, 1000000u}) {
        LightingCase input = sum_case(count);
        check_sum(findings, gpu, input);
        if (count == 1 || count == 1000000) continue;
        std::mt19937 random(181);
        std::shuffle(input.lights.begin(), input.lights.end(), random);
        check_sum(findings, gpu, input);
    }
}

void try_narrow_lobes(const Gpu& gpu, Findings& findings) {
    for (const double n : {1.0, 2.0, 8.0, 32.0, 100.0, 1000.0, 10000.0}) {
        check_lobe(findings, gpu, SHADING_BLINN_PHONG, roughness_of(n), 1e-5);
    }
    // Roughness 0 is clamped to 0.045: alpha 0.002.
    for (const double roughness : {0.0, 0.045, 0.06, 0.1, 0.3, 0.6, 1.0}) {
        check_lobe(findings, gpu, SHADING_PBR, roughness, 5e-5);
    }
}

}  // namespace kilolux
