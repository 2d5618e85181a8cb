// SPDX-License-Identifier: Apache-2.0
// Bounds of what lights add to the terms of a LightSum.
#ifndef KILOLUX_DEVICE_LOBE_BOUND_H
#define KILOLUX_DEVICE_LOBE_BOUND_H
#include "kernels/shared/evaluate.h"

// More than the rounding of sums.
#define ROUNDING 1.0001f

// Adds to a bound light from directions with n.h <= `cosine` and Schlick's rise <= `fresnel`.
// `diffuse`: what the diffuse term gets at most; `all`: the sum of intensity / distance^2;
// `irradiance`: the same times n.l.
static inline LightSum add_bounds(LightSum sum, Surface s, ShadingPoint p, float cosine,
                                  float fresnel, FV3 diffuse, FV3 irradiance, FV3 all) {
    sum.diffuse = add3(sum.diffuse, diffuse);
#if SHADING == SHADING_PBR
    // D V n.l without 1 / (2 pi): V n.l <= 1 / (2 smith_v).
    float ggx = fma(1.0f - cosine * cosine, p.ggx_slope, p.ggx_floor);
    float peak = 1.0f / (ggx * ggx * p.smith_v);
    FV3 f0 = mixed_f0(s, dielectric_f0(s));
    FV3 most = fv3(min(f0.x + fresnel, 1.0f), min(f0.y + fresnel, 1.0f), min(f0.z + fresnel, 1.0f));
    sum.specular =
        fv3(fma(most.x, peak * all.x, sum.specular.x), fma(most.y, peak * all.y, sum.specular.y),
            fma(most.z, peak * all.z, sum.specular.z));
#elif SHADING == SHADING_BLINN_PHONG
    float peak = pow_of_cos2(cosine * cosine, 1.0f - cosine * cosine, 1.0f, p.exponent);
    sum.specular = add3(sum.specular, scale3(irradiance, peak));
#endif
    return sum;
}
#endif
