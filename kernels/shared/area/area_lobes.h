// SPDX-License-Identifier: Apache-2.0
// The light of area lights on surfaces: as lobes/pbr.h for points. Of SHADING_LAMBERT the diffuse
// part; SHADING_BLINN_PHONG has none. Switch: HAS_AREA_LIGHTS of surface.h.
//
// Diffuse light and sheen depend on the light's direction beyond the cosine: by Schlick's
// reflectance and by the sheen's lobe. Both are taken in the direction of a typical point. Mean
// errors [%] by the light's width / distance, where n.v is at least 0.2
// (tests/measure/area/area_lobes_test.cpp):
//   material                               0.05   0.4   1.5
//   dielectric of roughness 1              0.02   0.3   0.5
//   the same with sheen of roughness 0.5   0.1    1.3   6
//   metal of roughness 0.4                 0.5    3     6
//   the same with anisotropy 0.6           2      15    24
// Narrow lobes of strong anisotropy are rough approximations.
#ifndef KILOLUX_SHARED_AREA_AREA_LOBES_H
#define KILOLUX_SHARED_AREA_AREA_LOBES_H
#include "kernels/shared/area/ggx_area.h"
#include "kernels/shared/lobes/light_sum.h"
#include "kernels/shared/lobes/passed_light.h"
#include "kernels/shared/lobes/pbr.h"
#include "kernels/shared/surface.h"
#include "kernels/shared/types.h"

#if HAS_AREA_LIGHTS != 0 && SHADING != SHADING_BLINN_PHONG
#if defined(__cplusplus)
namespace kilolux {
#endif

#if SHADING == SHADING_PBR
#if HAS_COAT
// 2 pi times the light of luminance 1 that a coat of share 1 reflects. `view`, `framed`: the light
// in view space, and in the frame of the surface.
SHARED_FN FV coat_area_light(ShadingPoint p, FramedLight view, FramedLight framed) {
#if HAS_COAT_NORMAL
    return area_ggx(p.coat_frame, p.coat, p.coat_area, light_in_frame(p.coat_frame, view)).light;
#else
    return area_ggx(p.frame, p.coat, p.coat_area, framed).light;
#endif
}
#endif

#if HAS_SHEEN_LOBE
// As sheen_light() times the solid angle of the light, from the unit direction l.
SHARED_FN FV sheen_area_light(ShadingPoint p, FV3 l, FV cosine) {
    FV3 h = fv3(p.frame.eye_x + l.x, l.y, p.frame.eye_z + l.z);
    FV sin2 = fma(h.x, h.x, h.y * h.y), cos2 = h.z * h.z;
    FV lobe = sheen_light(p.sheen, sin2, cos2, max(sin2 + cos2, fv(1e-12f)), l.z);
    return lobe * min(lane_divide(cosine, max(l.z, fv(1e-6f))), fv(6.28318531f));
}
#endif

// Adds a light of luminance `weight` * color. `view`: in view space, its centre relative to the
// shading point.
SHARED_FN LightSum add_area_lobes(LightSum sum, ShadingPoint p, FramedLight view, FV weight,
                                  float4 color) {
    FramedLight framed = light_in_frame(p.frame, view);
    FV cosine = area_irradiance(framed, false);
#if !(HAS_COAT && HAS_COAT_NORMAL)
    // Below the horizon of all lobes. A lane has the same light whatever the others have.
    MASK above_horizon = cosine > fv(0.0f);
    if (!lane_any(above_horizon)) return sum;
    weight = lane_select(above_horizon, weight, fv(0.0f));
#endif
    FV3 v = typical_vector(
        framed, typical_point(equal_variance_parallelogram(framed), inverse_variance_of(framed)));
    FV3 l = scale3(v, lane_rsqrt(max(dot3(v, v), fv(1e-30f))));
    FV cos2_half = fma(p.frame.eye_x, l.x, fma(p.frame.eye_z, l.z, fv(1.0f)));  // 2 (v.h)^2
    FV cos_half = lane_sqrt(max(fv(0.5f) * cos2_half, fv(0.0f)));
    FV kept = diffuse_share(p, schlick_rise(fv(1.0f) - cos_half));
    FV3 above = zero3();
    FV below = weight;
#if HAS_COAT
    if (lane_any(p.coat_share > fv(0.0f))) {
        FV coat = weight * p.coat_share * coat_area_light(p, view, framed);
        above = fv3(coat, coat, coat);
        below = below * p.below_coat;
    }
#endif
#if HAS_SHEEN_LOBE
    if (lane_any(p.sheen_most > fv(0.0f))) {
        FV sheen = weight * sheen_area_light(p, l, cosine);
        above = fv3(fma(sheen, p.sheen_color.x, above.x), fma(sheen, p.sheen_color.y, above.y),
                    fma(sheen, p.sheen_color.z, above.z));
        below = below * below_sheen(p, l.z);
    }
#endif
    sum.diffuse = add_scaled(sum.diffuse, below * cosine * kept, color);
    LobeLight specular = area_ggx(p.frame, p.lobe, p.area, framed);
    return add_specular(sum, p, below * specular.light, specular.rise, fv(1.0f) - specular.rise,
                        above, color);
}
#else
SHARED_FN LightSum add_area_lobes(LightSum sum, ShadingPoint p, FramedLight view, FV weight,
                                  float4 color) {
    FV cosine = area_irradiance(light_in_frame(p.frame, view), false);
    sum.diffuse = add_scaled(sum.diffuse, weight * cosine, color);
    return sum;
}
#endif

// Adds the light of a row with a size. v: from the shading point to its centre; window: the factor
// of its range; color: intensity straight ahead [cd].
SHARED_FN LightSum add_area_light(LightSum sum, ShadingPoint p, LightShape shape, FV3 v, FV window,
                                  float4 color) {
    return add_area_lobes(sum, p, seen_light(v, shape), window * fv(shape.half_y.w), color);
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
#endif
