// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/reference_brdf.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "host/measure/reference/reference_sheen.h"

namespace kilolux {
namespace {

constexpr double kRoughnessMin = 0.045;  // Filament: float32 cannot resolve narrower lobes
constexpr double kNDotVMin = 1e-4;       // Filament: surfaces seen edge-on
constexpr double kHalfMin = 1e-6;        // opposite directions of view and light: no half vector

double alpha2_of(double roughness) {
    const double r = std::max(roughness, kRoughnessMin);
    return r * r * r * r;
}

glm::dvec3 diffuse_of(const SurfaceSample& surface) {
    return surface.albedo *
           ((1.0 - surface.metallic) * (1.0 - surface.transmission) / std::numbers::pi);
}

glm::dvec3 f0_of(const SurfaceSample& surface) {
    return glm::mix(surface.specular, surface.albedo, surface.metallic);
}

// Share that the Fresnel term takes from diffuse reflection: the dielectric's strongest channel
// serves all three.
glm::dvec3 diffuse_loss(const SurfaceSample& s, double schlick) {
    const double most = std::max({s.specular.x, s.specular.y, s.specular.z});
    const glm::dvec3 head_on = glm::mix(glm::dvec3(most), s.albedo, s.metallic);
    // 1 - F of the dielectric at grazing angles, relative to that at normal incidence.
    const double grazing = std::min((1.0 - s.specular_f90) / std::max(1.0 - most, 1e-6), 1.0);
    return 1.0 - (1.0 - head_on) * (1.0 - schlick + schlick * grazing);
}

// The share of the base that lets light through.
double transmitting(const SurfaceSample& s, Shading model) {
    return s.transmission * (model == Shading::lambert ? 1.0 : 1.0 - s.metallic);
}

glm::dvec3 half_vector(const glm::dvec3& to_eye, const glm::dvec3& to_light) {
    const glm::dvec3 sum = to_eye + to_light;
    return sum / std::max(glm::length(sum), kHalfMin);
}

// sin^2 of the angle between n and h. At the peak of a narrow lobe 1 - (n.h)^2 would cancel; the
// cross product does not, also for a decoded normal that is not quite unit.
double sin2(const glm::dvec3& n, const glm::dvec3& h) {
    const glm::dvec3 c = glm::cross(n, h);
    return std::min(glm::dot(c, c), 1.0);
}

glm::dvec3 blinn_phong(const SurfaceSample& s, const glm::dvec3& v, const glm::dvec3& l) {
    const glm::dvec3 h = half_vector(v, l);
    const double exponent = 2.0 / alpha2_of(s.roughness) - 2.0;
    const double lobe = glm::dot(s.normal, h) > 0.0
                            ? std::exp(0.5 * exponent * std::log1p(-sin2(s.normal, h)))
                            : 0.0;  // also of exponent 0: the limit of small ones
    return diffuse_of(s) + f0_of(s) * ((exponent + 2.0) / (8.0 * std::numbers::pi) * lobe);
}

// D of GGX (Walter et al. 2007): alpha^2 / (pi (cos^2 (alpha^2 - 1) + 1)^2).
double ggx(double sin2_nh, double alpha2) {
    const double denominator = sin2_nh * (1.0 - alpha2) + alpha2;
    return alpha2 / (std::numbers::pi * denominator * denominator);
}

// Smith's height-correlated masking-shadowing over 4 n.l n.v (Heitz 2014, equation 99).
double smith_visibility(double n_dot_l, double n_dot_v, double alpha2) {
    const double over_v = n_dot_l * std::sqrt(n_dot_v * n_dot_v * (1.0 - alpha2) + alpha2);
    const double over_l = n_dot_v * std::sqrt(n_dot_l * n_dot_l * (1.0 - alpha2) + alpha2);
    return 0.5 / (over_v + over_l);
}

// D V of a lobe, with a cosine to the light of at least 0.
double lobe_of(const glm::dvec3& n, double alpha2, const glm::dvec3& v, const glm::dvec3& l) {
    const double n_dot_l = std::max(glm::dot(n, l), 0.0);
    const double n_dot_v = std::max(glm::dot(n, v), kNDotVMin);
    return ggx(sin2(n, half_vector(v, l)), alpha2) * smith_visibility(n_dot_l, n_dot_v, alpha2);
}

// D V stretched along the surface's tangent (KHR_materials_anisotropy).
double stretched_lobe(const SurfaceSample& s, const glm::dvec3& v, const glm::dvec3& l) {
    const double across2 = alpha2_of(s.roughness), across = std::sqrt(across2);
    const double along = std::lerp(across, 1.0, s.anisotropy * s.anisotropy);
    const glm::dvec3 h = half_vector(v, l), t = s.tangent;
    const double t_h = glm::dot(t, h), b_h = glm::dot(glm::cross(s.normal, t), h);
    const double n_h2 = 1.0 - sin2(s.normal, h);
    const double x = t_h * t_h / (along * along) + b_h * b_h / across2 + n_h2;
    // Of a unit direction: |(along d.t, across d.b, d.n)|.
    const auto smith = [&](double n_dot, double t_dot) {
        return std::sqrt(n_dot * n_dot * (1.0 - across2) + across2 +
                         t_dot * t_dot * (along * along - across2));
    };
    const double n_dot_l = std::max(glm::dot(s.normal, l), 0.0);
    const double n_dot_v = std::max(glm::dot(s.normal, v), kNDotVMin);
    const double over =
        n_dot_l * smith(n_dot_v, glm::dot(t, v)) + n_dot_v * smith(n_dot_l, glm::dot(t, l));
    return 0.5 / (over * std::numbers::pi * along * across * x * x);
}

glm::dvec3 pbr(const SurfaceSample& s, const glm::dvec3& v, const glm::dvec3& l) {
    const glm::dvec3 h = half_vector(v, l);
    const glm::dvec3 f0 = f0_of(s);
    const double schlick = std::pow(std::max(1.0 - glm::dot(v, h), 0.0), 5.0);
    const double f90 = 1.0 - (1.0 - s.metallic) * (1.0 - s.specular_f90);
    const glm::dvec3 fresnel = f0 + (f90 - f0) * schlick;
    const double lobe = s.anisotropy > 0.0 ? stretched_lobe(s, v, l)
                                           : lobe_of(s.normal, alpha2_of(s.roughness), v, l);
    // glTF's appendix B mixes whole BRDFs by metallic. Here, as in the kernels, F0 is mixed first
    // and both lobes share one F.
    return diffuse_of(s) * (1.0 - diffuse_loss(s, schlick)) + fresnel * lobe;
}

}  // namespace

glm::dvec3 reference_brdf(const SurfaceSample& surface, const glm::dvec3& to_eye,
                          const glm::dvec3& to_light, Shading model) {
    assert(model != Shading::automatic);
    switch (model) {
        case Shading::blinn_phong:
            return blinn_phong(surface, to_eye, to_light);
        case Shading::pbr:
            return pbr(surface, to_eye, to_light);
        default:
            return surface.albedo * ((1.0 - surface.transmission) / std::numbers::pi);
    }
}

double reference_coat_share(const SurfaceSample& surface, const glm::dvec3& to_eye, Shading model) {
    if (model != Shading::pbr || surface.kind == SurfaceKind::unlit) return 0.0;
    const double n_dot_v = std::max(glm::dot(surface.coat_normal, to_eye), kNDotVMin);
    return surface.coat * (0.04 + 0.96 * std::pow(std::max(1.0 - n_dot_v, 0.0), 5.0));
}

glm::dvec3 reference_ambient_albedo(const SurfaceSample& s, const glm::dvec3& to_eye,
                                    Shading model) {
    const glm::dvec3 albedo = s.albedo * (1.0 - transmitting(s, model));
    if (model != Shading::pbr) return albedo;
    const double n_dot_v = std::max(glm::dot(s.normal, to_eye), kNDotVMin);
    const double taken = reference_sheen_albedo(n_dot_v, s.sheen_roughness);
    return albedo * (1.0 - std::max({s.sheen.x, s.sheen.y, s.sheen.z}) * taken) + s.sheen * taken;
}

glm::dvec3 reference_share_behind(const SurfaceSample& s, const glm::dvec3& to_eye, Shading model) {
    glm::dvec3 through = s.albedo * s.tint * transmitting(s, model);
    if (model == Shading::pbr) {
        const double n_dot_v = std::max(glm::dot(s.normal, to_eye), kNDotVMin);
        const double schlick = std::pow(std::max(1.0 - n_dot_v, 0.0), 5.0);
        const double taken = reference_sheen_albedo(n_dot_v, s.sheen_roughness);
        SurfaceSample dielectric = s;
        dielectric.metallic = 0.0;
        through *= 1.0 - diffuse_loss(dielectric, schlick);
        through *= 1.0 - std::max({s.sheen.x, s.sheen.y, s.sheen.z}) * taken;
        through *= 1.0 - reference_coat_share(s, to_eye, model);
    }
    return 1.0 - s.coverage + s.coverage * through;
}

glm::dvec3 reference_reflection(const SurfaceSample& surface, const glm::dvec3& to_eye,
                                const glm::dvec3& to_light, Shading model) {
    const double n_dot_l = glm::dot(surface.normal, to_light);
    const double coat_dot_l = glm::dot(surface.coat_normal, to_light);
    const double share = reference_coat_share(surface, to_eye, model);
    glm::dvec3 out(0.0);
    if (n_dot_l > 0.0) {
        glm::dvec3 below = n_dot_l * reference_brdf(surface, to_eye, to_light, model);
        if (model == Shading::pbr && surface.sheen != glm::dvec3(0.0)) {
            const double n_dot_v = std::max(glm::dot(surface.normal, to_eye), kNDotVMin);
            below *= reference_below_sheen(surface, n_dot_v, n_dot_l);
            below += surface.sheen * reference_sheen(surface, to_eye, to_light);
        }
        out += (1.0 - share) * below;
    }
    if (coat_dot_l > 0.0 && share > 0.0) {
        const double alpha2 = alpha2_of(surface.coat_roughness);
        out += share * coat_dot_l * lobe_of(surface.coat_normal, alpha2, to_eye, to_light);
    }
    return out;
}

}  // namespace kilolux
