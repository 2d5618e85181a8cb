// SPDX-License-Identifier: Apache-2.0
// Grazing light, grazing views, and surfaces that face away from the eye.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/certify/cases.h"
#include "kernels/shared/evaluate_modes.h"

namespace kilolux {
namespace {

constexpr double kAngles[] = {1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2};

// Surfaces on the axis, each with a light that reaches no other. The normal, not the light's
// position, sets the angle: float32 holds 1e-7 there.
LightingCase grazing_case(int shading) {
    std::vector<SurfaceSample> surfaces;
    std::vector<Light> lights;
    const auto add = [&](const glm::dvec3& normal, const glm::dvec3& to_light) {
        const double z = 1.0 + 0.5 * static_cast<double>(surfaces.size());
        surfaces.push_back(grey_surface({0, 0, -z}, normal));
        lights.push_back(point_light(surfaces.back().position + 0.2 * to_light, 0.4));
    };
    for (const double angle : kAngles) {
        for (const double a : {angle, -angle}) {
            add({std::sin(a), 0, std::cos(a)}, {1, 0, 0});                      // n.l -> 0
            add({std::cos(a), 0, std::sin(a)}, {0.8, 0.6, 0});                  // n.v -> 0
            add({0, std::cos(a), std::sin(a)}, {std::cos(a), std::sin(a), 0});  // both
        }
    }
    LightingCase input = surface_case(surfaces, shading);
    input.lights = lights;
    return input;
}

// A random unit vector at an angle of asin(sine) above the horizon of `l`.
glm::dvec3 tilted(const glm::dvec3& l, double sine, Random& random) {
    const glm::dvec3 across = glm::normalize(glm::cross(l, random.direction()));
    return sine * l + std::sqrt(1.0 - sine * sine) * across;
}

uint packed_normal(const glm::dvec3& n) {
    const glm::vec3 f(n);
    const FV3 e = octahedral_encode(fv3(f.x, f.y, f.z));
    const auto code = [](float v) {
        return static_cast<uint>(std::lround((v * 0.5 + 0.5) * 65535));
    };
    return code(e.x) | code(e.y) << 16;
}

// A directional light 1e-4 rad below every pixel's horizon: more than the 6.6e-5 rad by which 2x16
// bits turn a normal.
void check_lit_from_behind(const Gpu& gpu, Findings& findings) {
    LightingCase input =
        noise_case({64, 48}, noise_depth(1.0, 9.0, 0, 4), every_feature(SHADING_LAMBERT));
    put_out_surfaces(input);
    const glm::vec3 to_light(glm::normalize(glm::dvec3(0.3, 0.5, 0.7)));
    input.directional_lights = {{{to_light.x, to_light.y, to_light.z, 0}, {1, 1, 1, 0}}};
    const glm::dvec3 l = glm::normalize(view_from_world(input.image.view, to_light));
    Random random(23);
    auto* normals = input.image.plane<uint>(PLANE_NORMAL);
    const std::size_t pixels = std::size_t{input.image.view.stride} * input.image.view.height;
    for (std::size_t i = 0; i < pixels; ++i) {
        normals[i] = packed_normal(tilted(l, -std::sin(1e-4), random));
    }
    const std::uint64_t lit = count_lit(light_on_device(gpu, input).listed);
    findings.none("values lit from 1e-4 rad below the horizon", lit, 3 * pixels);
}

// Surfaces that face in random directions, also away from the eye, lit by one light.
LightingCase facing_away_case() {
    std::vector<SurfaceSample> surfaces;
    Random random(231);
    for (int i = 0; i < 1024; ++i) {
        const glm::dvec3 normal = random.direction();
        surfaces.push_back(grey_surface({0, 0, -random.uniform(2, 6)}, normal));
        surfaces.back().roughness = i % 4 == 0 ? 1.0 : random.uniform(0.3, 1.0);
    }
    LightingCase input = surface_case(surfaces, SHADING_BLINN_PHONG, 64);
    input.lights = {point_light({1, 2, -9}, 90.0, {50, 50, 50})};
    return input;
}

// F0 (0.04) times the change of the lobe (n + 2) / (8 pi) (n.h)^n where n.h is off by 8 u, the
// error of float32 unit vectors. For exponents n < 1 (roughness above 0.904) the slope at n.h = 0
// is infinite, and the change is large: (8 u)^0.1 = 0.23.
double lobe_uncertainty(const SurfaceSample& s, const glm::dvec3& l) {
    constexpr double kOff = 8 * 0x1p-24;
    const double alpha2 = std::pow(std::max(s.roughness, 0.045), 4.0);
    const double exponent = 2.0 / alpha2 - 2.0;
    const glm::dvec3 h = glm::normalize(l + glm::normalize(-s.position));
    const double cosine = glm::dot(s.normal, h);
    const auto lobe = [&](double c) {
        return c > 0.0 ? std::pow(std::min(c, 1.0), exponent) : 0.0;
    };
    return 0.04 * (exponent + 2.0) / (8.0 * std::numbers::pi) *
           (lobe(cosine + kOff) - lobe(cosine - kOff));
}

// |x - r| in units of 1e-5 max(r, E) plus the lobe's uncertainty.
Worst facing_away_error(const LightingCase& input, const DeviceResult& result) {
    const ReferencePicture r1 = r1_picture(input, result);
    const SurfaceSamples surfaces = decoded_surfaces(input, result);
    const glm::dvec3 light = xyz(result.lights.front().position_inv_range2);
    Worst worst;
    std::size_t i = 0;
    for_each_pixel(input.image.view, [&](uint x, uint y) {
        const SurfaceSample& s = surfaces.pixels[i];
        const glm::dvec3 l = glm::normalize(light - s.position);
        const double expected = r1.radiance.rgb[3 * i];
        const double scale = r1.scale.rgb[3 * i++];
        const double allowed =
            1e-5 * std::max(expected, scale) +
            scale * std::max(glm::dot(s.normal, l), 0.0) * lobe_uncertainty(s, l);
        worst.add(std::abs(result.radiance(x, y, 0) - expected) / allowed,
                  [&] { return fmt::format("{}, roughness {:f}", at_pixel(x, y), s.roughness); });
    });
    return worst;
}

}  // namespace

void try_grazing_angles(const Gpu& gpu, Findings& findings) {
    const LightingCase lambert = grazing_case(SHADING_LAMBERT);
    const DeviceResult matt = light_on_device(gpu, lambert);
    findings.at_most("Lambert: |x-r|/E", error_against_r1(lambert, matt), 1e-6);
    check_exact(findings, lambert, matt);
    for (const int shading : {SHADING_BLINN_PHONG, SHADING_PBR}) {
        const LightingCase input = grazing_case(shading);
        findings.at_most("lobes: |x-r|/max(r,E)",
                         error_against_r1(input, light_on_device(gpu, input)), 1e-5);
    }
    check_lit_from_behind(gpu, findings);
    const LightingCase away = facing_away_case();
    findings.at_most("Blinn-Phong facing away: error / bound",
                     facing_away_error(away, light_on_device(gpu, away)), 1.0);
}

}  // namespace kilolux
