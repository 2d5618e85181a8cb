// SPDX-License-Identifier: Apache-2.0
#include "tests/opencl/shading/shading_reference.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "kernels/shared/evaluate_modes.h"
#include "kernels/shared/lobes/sheen.h"

namespace kilolux {
namespace {

constexpr double kNearest = 0.01;     // [m] light sources have a size
constexpr double kSmoothest = 0.045;  // perceptual roughness
constexpr double kSmallestNdotV = 1e-4;

glm::dvec3 dvec3_of(float4 v) { return {v.x, v.y, v.z}; }

double clamp01(double x) { return std::clamp(x, 0.0, 1.0); }

double alpha_of(double roughness) {
    const double r = std::max(roughness, kSmoothest);
    return r * r;
}

// KHR_materials_anisotropy, "Anisotropy" and "Individual lights": D V, without the clamp of V to 1
// by which its example spares half floats.
double stretched_brdf(const SurfaceD& s, glm::dvec3 n, glm::dvec3 v, glm::dvec3 l) {
    const glm::dvec3 h = glm::normalize(l + v), t = glm::normalize(s.tangent), b = cross(n, t);
    const double ab = alpha_of(s.roughness);
    const double at = std::lerp(ab, 1.0, s.anisotropy * s.anisotropy);
    const double nl = std::max(dot(n, l), 0.0), nv = std::max(dot(n, v), kSmallestNdotV);
    const glm::dvec3 f(ab * dot(t, h), at * dot(b, h), at * ab * dot(n, h));
    const double w2 = at * ab / dot(f, f);
    const double over = nl * glm::length(glm::dvec3(at * dot(t, v), ab * dot(b, v), nv)) +
                        nv * glm::length(glm::dvec3(at * dot(t, l), ab * dot(b, l), nl));
    return at * ab * w2 * w2 / std::numbers::pi * 0.5 / over;
}

// glTF 2.0 appendix B, metallic-roughness, without the cosine to the light.
glm::dvec3 gltf_brdf(const SurfaceD& s, glm::dvec3 n, glm::dvec3 v, glm::dvec3 l) {
    const double a2 = alpha_of(s.roughness) * alpha_of(s.roughness);
    const glm::dvec3 h = glm::normalize(l + v);
    const double nh = dot(n, h);
    const double nl = std::max(dot(n, l), 0.0);
    const double nv = std::max(dot(n, v), kSmallestNdotV);
    const double t = nh * nh * (a2 - 1) + 1;
    const double distribution = a2 / (std::numbers::pi * t * t);
    const double visibility =
        0.5 / (nl * std::sqrt(nv * nv * (1 - a2) + a2) + nv * std::sqrt(nl * nl * (1 - a2) + a2));
    const double lobe = s.anisotropy > 0 ? stretched_brdf(s, n, v, l) : distribution * visibility;
    const double schlick = std::pow(std::max(1 - dot(v, h), 0.0), 5);
    // KHR_materials_specular: diffuse light loses the strongest channel of the dielectric's Fresnel
    // term; that share of what is lost head on is the metal's as well.
    const double most = std::max({s.specular.x, s.specular.y, s.specular.z});
    const double rises = std::min((1 - s.specular_f90) / std::max(1 - most, 1e-6), 1.0);
    const double to_diffuse = 1 - schlick + schlick * rises;
    const double f90 = s.specular_f90 + (1 - s.specular_f90) * s.metallic;
    const auto channel = [&](double albedo, double specular) {
        const double f0 = specular + (albedo - specular) * s.metallic;
        const double f = f0 + (f90 - f0) * schlick;
        const double kept = (1 - (most + (albedo - most) * s.metallic)) * to_diffuse;
        return kept * albedo * (1 - s.metallic) / std::numbers::pi + f * lobe;
    };
    return {channel(s.albedo.x, s.specular.x), channel(s.albedo.y, s.specular.y),
            channel(s.albedo.z, s.specular.z)};
}

// glTF 2.0 appendix B.3.2, specular_brdf(): V D in fractions, as the text writes them.
double specular_brdf(glm::dvec3 n, double roughness, glm::dvec3 v, glm::dvec3 l) {
    const double a2 = alpha_of(roughness) * alpha_of(roughness);
    const glm::dvec3 h = glm::normalize(l + v);
    const double nl = std::max(dot(n, l), 0.0), nv = std::max(dot(n, v), kSmallestNdotV);
    // 1 - (n.h)^2 cancels at the peak of a narrow lobe.
    const double d = a2 + (1 - a2) * dot(cross(n, h), cross(n, h));
    const double over =
        nl * std::sqrt(a2 + (1 - a2) * nv * nv) + nv * std::sqrt(a2 + (1 - a2) * nl * nl);
    return a2 / (std::numbers::pi * d * d) * 0.5 / over;
}

// KHR_materials_clearcoat, "Layering": coated_material = fresnel_coat(normal, ior = 1.5, weight,
// base, layer) = mix(base, layer, weight * (f0 + (1 - f0) (1 - |N.V|)^5)).
double coat_weight(const SurfaceD& s, glm::dvec3 v) {
    const double f0 = std::pow((1 - 1.5) / (1 + 1.5), 2);
    const double nv = std::max(dot(glm::normalize(s.coat_normal), v), kSmallestNdotV);
    return s.coat * (f0 + (1 - f0) * std::pow(std::max(1 - nv, 0.0), 5));
}

// KHR_materials_sheen, "Sheen visibility".
double sheen_l(double x, double alpha) {
    const double t = (1 - alpha) * (1 - alpha);
    const double a = std::lerp(21.5473, 25.3245, t), b = std::lerp(3.82987, 3.32435, t);
    const double c = std::lerp(0.19823, 0.16801, t), d = std::lerp(-1.97760, -1.27393, t);
    const double e = std::lerp(-4.32054, -4.85967, t);
    return a / (1 + b * std::pow(x, c)) + d * x + e;
}

double lambda_sheen(double cosine, double alpha) {
    return cosine < 0.5 ? std::exp(sheen_l(cosine, alpha))
                        : std::exp(2 * sheen_l(0.5, alpha) - sheen_l(1 - cosine, alpha));
}

// Ibid., E() by the coefficients of the kernels.
double sheen_albedo(double x, double roughness) {
    const double r = std::max(roughness, 0.045);
    double power = 1, sum = 0;
#define ADD_POWER(name, one, of_r, of_r2, of_r3, of_inverse, of_inverse2)                        \
    sum += power *                                                                               \
           (double{one} + double{of_r} * r + double{of_r2} * r * r + double{of_r3} * r * r * r + \
            double{of_inverse} / r + double{of_inverse2} / (r * r));                             \
    power *= x;
    SHEEN_ALBEDO_ROWS(ADD_POWER)
#undef ADD_POWER
    return std::exp2(std::min(sum, 0.0));
}

double most_of(glm::dvec3 c) { return std::max({c.x, c.y, c.z}); }

// f_sheen n.l + f_base n.l sheenAlbedoScaling.
glm::dvec3 with_sheen(const SurfaceD& s, glm::dvec3 base, glm::dvec3 v, glm::dvec3 l) {
    const glm::dvec3 n = glm::normalize(s.normal), h = glm::normalize(l + v);
    const double alpha = alpha_of(s.sheen_roughness);
    const double nv = std::max(dot(n, v), kSmallestNdotV), nl = std::min(dot(n, l), 1.0);
    const double sin2h = std::min(dot(cross(n, h), cross(n, h)), 1.0);
    const double d = (2 + 1 / alpha) * std::pow(sin2h, 0.5 / alpha) / (2 * std::numbers::pi);
    const double shadow = 1 + lambda_sheen(std::min(nv, 1.0), alpha) + lambda_sheen(nl, alpha);
    const double taken =
        std::max(sheen_albedo(nv, s.sheen_roughness), sheen_albedo(nl, s.sheen_roughness));
    return s.sheen * (d / (shadow * 4 * nv)) + base * (1 - most_of(s.sheen) * taken);
}

glm::dvec3 blinn_phong_brdf(const SurfaceD& s, glm::dvec3 n, glm::dvec3 v, glm::dvec3 l) {
    const double exponent = 2 / std::pow(alpha_of(s.roughness), 2) - 2;
    const double nh = std::max(dot(n, glm::normalize(l + v)), 0.0);
    const double lobe = (exponent + 2) / (8 * std::numbers::pi) * std::pow(nh, exponent);
    const auto channel = [&](double albedo, double specular) {
        const double f0 = specular + (albedo - specular) * s.metallic;
        return albedo * (1 - s.metallic) / std::numbers::pi + f0 * lobe;
    };
    return {channel(s.albedo.x, s.specular.x), channel(s.albedo.y, s.specular.y),
            channel(s.albedo.z, s.specular.z)};
}

glm::dvec3 brdf(int shading, const SurfaceD& s, glm::dvec3 n, glm::dvec3 v, glm::dvec3 l) {
    if (shading == SHADING_PBR) return gltf_brdf(s, n, v, l);
    if (shading == SHADING_BLINN_PHONG) return blinn_phong_brdf(s, n, v, l);
    return s.albedo * (1 / std::numbers::pi);
}

double cone_of(const ShadeLight& light, glm::dvec3 to_light) {
    const double cosine = -dot(to_light, dvec3_of(light.axis_cos));
    const double t = clamp01((cosine - light.axis_cos.w) * light.color_scale.w);
    return t * t;
}

}  // namespace

ReferenceRadiance reference_radiance(const SurfaceD& s, const Lighting& lighting) {
    const glm::dvec3 n = glm::normalize(s.normal);
    const glm::dvec3 eye =
        lighting.orthographic ? glm::dvec3{0, 0, 1} : glm::normalize(s.position * -1.0);
    const glm::dvec3 coat_normal = glm::normalize(s.coat_normal);
    const double weight = lighting.shading == SHADING_PBR ? coat_weight(s, eye) : 0;
    const bool has_sheen = lighting.shading == SHADING_PBR && most_of(s.sheen) > 0;
    ReferenceRadiance sum;
    const auto add = [&](glm::dvec3 l, glm::dvec3 strength) {
        sum.scale += std::max({strength.x, strength.y, strength.z});
        if (strength.x + strength.y + strength.z == 0) return;
        const double nl = dot(n, l), coat_nl = dot(coat_normal, l);
        if (nl > 0) {
            const glm::dvec3 base = brdf(lighting.shading, s, n, eye, l) * nl;
            sum.value += (has_sheen ? with_sheen(s, base, eye, l) : base) * strength * (1 - weight);
        }
        if (coat_nl > 0 && weight > 0) {
            sum.value += strength *
                         (coat_nl * weight * specular_brdf(coat_normal, s.coat_roughness, eye, l));
        }
    };
    for (const DirectionalLight& light : lighting.directional)
        add(dvec3_of(light.to_light), dvec3_of(light.color));
    for (const ShadeLight& light : lighting.lights) {
        const glm::dvec3 offset = dvec3_of(light.position_inv_range2) - s.position;
        const double d2 = dot(offset, offset);
        const double ratio4 = std::pow(d2 * light.position_inv_range2.w, 2);
        const double d = std::max(std::sqrt(d2), kNearest);
        const glm::dvec3 to_light = offset * (1 / d);  // shorter than 1 within the source itself
        const double falloff = clamp01(1 - ratio4) / (d * d) * cone_of(light, to_light);
        add(to_light, dvec3_of(light.color_scale) * falloff);
    }
    glm::dvec3 albedo = s.albedo;
    if (has_sheen) {
        const double taken = sheen_albedo(std::max(dot(n, eye), kSmallestNdotV), s.sheen_roughness);
        albedo = albedo * (1 - most_of(s.sheen) * taken) + s.sheen * taken;
    }
    const glm::dvec3 own = albedo * (lighting.ambient * s.occlusion) + s.emissive;
    sum.value += own * (1 - weight);
    sum.scale += weight * std::max({own.x, own.y, own.z});  // what the coat takes away
    return sum;
}

double relative_error(glm::dvec3 found, const ReferenceRadiance& expected) {
    const auto error = [&](double x, double r) {
        const double difference = std::abs(x - r);
        if (std::isnan(difference)) return std::numeric_limits<double>::infinity();
        const double size = std::max(r, expected.scale);
        return size > 0 ? difference / size : difference;
    };
    return std::max({error(found.x, expected.value.x), error(found.y, expected.value.y),
                     error(found.z, expected.value.z)});
}

}  // namespace kilolux
