// SPDX-License-Identifier: Apache-2.0
// Grazing light, grazing views, and surfaces that face away from the eye.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/certify/cases.h"
#include "host/certify/shot.h"
#include "kernels/shared/evaluate_modes.h"

namespace kilolux {
namespace {

constexpr double kAngles[] = {1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2};

SurfaceSample matt_surface(double z, const glm::dvec3& normal) {
    SurfaceSample s;
    s.position = {0, 0, -z};
    s.normal = normal;
    s.albedo = glm::dvec3(0.5);
    s.roughness = 0.5;
    s.kind = SurfaceKind::lit;
    return s;
}

// Surfaces on the axis, each with a light that no other one sees. Light comes along x, where the
// normal, not the light's position, makes the angle: float32 holds 1e-7 there.
Shot grazing_shot(int shading) {
    std::vector<SurfaceSample> surfaces;
    std::vector<Light> lights;
    const auto add = [&](const glm::dvec3& normal, const glm::dvec3& to_light) {
        const double z = 1.0 + 0.5 * static_cast<double>(surfaces.size());
        surfaces.push_back(matt_surface(z, normal));
        const glm::dvec3 p = surfaces.back().position + 0.2 * to_light;
        lights.push_back(point_light({p.x, p.y, p.z}, 0.4, {1, 1, 1}));
    };
    for (const double angle : kAngles) {
        for (const double a : {angle, -angle}) {
            add({std::sin(a), 0, std::cos(a)}, {1, 0, 0});                      // n.l -> 0
            add({std::cos(a), 0, std::sin(a)}, {0.8, 0.6, 0});                  // n.v -> 0
            add({0, std::cos(a), std::sin(a)}, {std::cos(a), std::sin(a), 0});  // both
        }
    }
    Shot shot = surface_shot(surfaces, shading);
    shot.lights = lights;
    return shot;
}

// Random unit vectors whose sine of the angle above the horizon of `l` is `sine`.
glm::dvec3 tilted(const glm::dvec3& l, double sine, Random& random) {
    const Vec3d r = random.direction();
    const glm::dvec3 across = glm::normalize(glm::cross(l, glm::dvec3(r.x, r.y, r.z)));
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

// A sun 1e-4 rad below every pixel's horizon, more than 2x16 bits turn a normal by (6.6e-5 rad).
std::uint64_t pixels_lit_from_behind(const Gpu& gpu, std::uint64_t& pixels) {
    Shot shot = noise_shot({64, 48}, noise_depth(1.0, 9.0, 0, 4), every_feature(SHADING_LAMBERT));
    put_out_surfaces(shot);
    const Vec3d sun = normalized({0.3, 0.5, 0.7});
    shot.suns = {
        {{static_cast<float>(sun.x), static_cast<float>(sun.y), static_cast<float>(sun.z), 0},
         {1, 1, 1, 0}}};
    const Vec3d v = view_from_world(shot.image.view, sun);
    const glm::dvec3 l = glm::normalize(glm::dvec3(v.x, v.y, v.z));
    Random random(23);
    auto* normals = shot.image.plane<uint>(PLANE_NORMAL);
    pixels = std::size_t{shot.image.view.stride} * shot.image.view.height;
    for (std::size_t i = 0; i < pixels; ++i) {
        normals[i] = packed_normal(tilted(l, -std::sin(1e-4), random));
    }
    std::uint64_t lit = 0;
    for (const float value : expose(gpu, shot).listed) lit += value != 0.0f ? 1 : 0;
    return lit;
}

// A surface that faces any way, the eye's side or not, and is lit from any other.
Shot facing_away_shot() {
    std::vector<SurfaceSample> surfaces;
    Random random(231);
    for (int i = 0; i < 1024; ++i) {
        const Vec3d n = random.direction();
        surfaces.push_back(matt_surface(random.uniform(2, 6), {n.x, n.y, n.z}));
        surfaces.back().roughness = i % 4 == 0 ? 1.0 : random.uniform(0.3, 1.0);
    }
    Shot shot = surface_shot(surfaces, SHADING_BLINN_PHONG, 64);
    shot.lights = {point_light({1, 2, -9}, 90.0, {50, 50, 50})};
    return shot;
}

// How much the lobe (n + 2) / (8 pi) (n.h)^n changes where n.h is off by 8 u, what unit vectors of
// float32 leave open. For exponents n < 1, that is roughness above 0.904, its slope at n.h = 0 is
// infinite and this is not small: (8 u)^0.1 = 0.23. Times F0 (0.04).
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
Worst facing_away_error(const Shot& shot, const Exposure& e) {
    const ReferencePicture r1 = r1_picture(shot, e);
    const SurfaceSamples surfaces = decoded_surfaces(shot, e);
    const float4 light = e.lights.front().position_inv_range2;
    const View& view = shot.image.view;
    Worst worst;
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.width; ++x) {
            const std::size_t i = std::size_t{y} * view.width + x;
            const SurfaceSample& s = surfaces.pixels[i];
            const glm::dvec3 l = glm::normalize(glm::dvec3(light.x, light.y, light.z) - s.position);
            const double scale = r1.scale.rgb[3 * i];
            const double allowed =
                1e-5 * std::max(r1.radiance.rgb[3 * i], scale) +
                scale * std::max(glm::dot(s.normal, l), 0.0) * lobe_uncertainty(s, l);
            const double found = e.listed[std::size_t{y} * view.stride + x];
            worst.see(std::abs(found - r1.radiance.rgb[3 * i]) / allowed, [&] {
                return at_pixel(x, y) + ", roughness " + std::to_string(s.roughness);
            });
        }
    }
    return worst;
}

}  // namespace

void try_grazing_angles(const Gpu& gpu, Findings& findings) {
    const Shot lambert = grazing_shot(SHADING_LAMBERT);
    const Exposure matt = expose(gpu, lambert);
    findings.at_most("Lambert: |x-r|/E", error_against_r1(lambert, matt), 1e-6);
    check_exact(findings, lambert, matt);
    for (const int shading : {SHADING_BLINN_PHONG, SHADING_PBR}) {
        const Shot shot = grazing_shot(shading);
        findings.at_most("lobes: |x-r|/max(r,E)", error_against_r1(shot, expose(gpu, shot)), 1e-5);
    }
    std::uint64_t pixels = 0;
    const std::uint64_t lit = pixels_lit_from_behind(gpu, pixels);
    findings.none("values lit from 1e-4 rad below the horizon", lit, 3 * pixels);
    const Shot away = facing_away_shot();
    findings.at_most("Blinn-Phong facing away: error / bound",
                     facing_away_error(away, expose(gpu, away)), 1.0);
}

}  // namespace kilolux
