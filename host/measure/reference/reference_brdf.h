// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "host/measure/reference/surface_samples.h"
#include "host/render/settings.h"

namespace kilolux {

/// The BRDF [1/sr] of a surface without its clear coat and sheen, in double, independent of the
/// kernels.
///
/// `to_eye` is unit; `to_light` is unit, or shorter for a light nearer than 1 cm.
/// lambert:     albedo / pi.
/// blinn_phong: (1 - metallic) albedo / pi + F0 (n + 2) / (8 pi) (n.h)^n, n = 2 / alpha^2 - 2.
/// pbr:         glTF 2.0 appendix B: (1 - metallic) albedo / pi (1 - F) + F D V with GGX, the
///              height-correlated Smith V (Heitz 2014) and Schlick's F at v.h.
/// F0 = mix(specular, albedo, metallic), F90 = mix(specular_f90, 1, metallic); diffuse light loses
/// the dielectric part's strongest channel of F (KHR_materials_specular). alpha = max(roughness,
/// 0.045)^2, n.v is at least 1e-4. KHR_materials_anisotropy stretches GGX and V.
/// `model` must not be Shading::automatic.
glm::dvec3 reference_brdf(const SurfaceSample& surface, const glm::dvec3& to_eye,
                          const glm::dvec3& to_light, Shading model);

/// The share of the clear coat in what the eye sees of a surface; the surface below it, with its
/// emission, keeps the rest. pbr: KHR_materials_clearcoat's fresnel_coat(); 0 otherwise.
double reference_coat_share(const SurfaceSample& surface, const glm::dvec3& to_eye, Shading model);

/// The share of ambient light that a surface without its clear coat sends to the eye. pbr: with its
/// sheen, as of even light from all directions.
glm::dvec3 reference_ambient_albedo(const SurfaceSample& surface, const glm::dvec3& to_eye,
                                    Shading model);

/// The share of the light behind a surface that it lets through to the eye: what alpha leaves
/// bare, and KHR_materials_transmission's of a smooth surface seen head on by its half vector.
glm::dvec3 reference_share_behind(const SurfaceSample& surface, const glm::dvec3& to_eye,
                                  Shading model);

/// Radiance that the surface sends to the eye by irradiance 1 from `to_light`, perpendicular to it:
/// BRDF times cosine of the surface with its sheen and of its coat, mixed by the coat's share.
glm::dvec3 reference_reflection(const SurfaceSample& surface, const glm::dvec3& to_eye,
                                const glm::dvec3& to_light, Shading model);

}  // namespace kilolux
