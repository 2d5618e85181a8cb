// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "host/certify/synthetic/random.h"
#include "kernels/shared/light.h"

namespace kilolux {

/// A point on a surface in view space: Surface of kernels/shared/evaluate.h in double.
struct SurfaceD {
    glm::dvec3 position{0.0};
    glm::dvec3 normal{0.0};  // any length
    glm::dvec3 albedo{0.5, 0.5, 0.5};
    glm::dvec3 emissive{0.0};
    double roughness = 1, metallic = 0, occlusion = 1;
    glm::dvec3 specular{0.04, 0.04, 0.04};  // reflectance of the dielectric part head on
    double specular_f90 = 1;                // and at grazing angles
    double coat = 0, coat_roughness = 1;    // KHR_materials_clearcoat
    glm::dvec3 coat_normal{0.0, 0.0, 1.0};  // any length
    glm::dvec3 sheen{0.0, 0.0, 0.0};        // KHR_materials_sheen
    double sheen_roughness = 1;
    glm::dvec3 tangent{1.0, 0.0, 0.0};  // KHR_materials_anisotropy: perpendicular to the normal
    double anisotropy = 0;
};

/// The lights and the view of a surface.
struct Lighting {
    std::span<const ShadeLight> lights;
    std::span<const DirectionalLight> directional;
    double ambient = 0;
    bool orthographic = false;
    int shading = 0;        // SHADING_*
    bool clearcoat = true;  // compiled in
    bool sheen = true;
    bool anisotropy = true;
};

struct ReferenceRadiance {
    glm::dvec3 value{0.0};
    double scale = 0;  // sum over lights of intensity * falloff, of the strongest channel: what
                       // rounding is relative to
};

/// Radiance in double, from the published formulas: windowed inverse square; Lambert, Blinn-Phong
/// (Walter et al. 2007), or glTF 2.0 appendix B (GGX, height-correlated Smith, Schlick).
ReferenceRadiance reference_radiance(const SurfaceD& surface, const Lighting& lighting);

/// |found - expected| relative to the larger of the expected value and the scale; NaN counts as
/// infinite.
double relative_error(glm::dvec3 found, const ReferenceRadiance& expected);

}  // namespace kilolux
