// SPDX-License-Identifier: Apache-2.0
// A light as the host uploads it, and as the kernels shade with it.
#ifndef KILOLUX_SHARED_LIGHT_H
#define KILOLUX_SHARED_LIGHT_H
#include "kernels/shared/types.h"
// Nearer than this the inverse square stops growing: light sources have a size [m] (Lagarde and de
// Rousiers 2014, "Moving Frostbite to PBR", 3.1: max(d^2, 0.01^2)). Scenes of less than 4 m are
// built with a smaller one: SceneFeatures::light_d_min.
#ifndef LIGHT_D_MIN
#define LIGHT_D_MIN 0.01f
#endif

#if defined(__cplusplus)
namespace kilolux {
#endif

// Programs that do not know the scene leave out what only some scenes have.
#if (defined(__OPENCL_C_VERSION__) || defined(__OPENCL_VERSION__)) && !defined(HAS_SPOT_LIGHTS)
#define HAS_SPOT_LIGHTS 0
#endif

// Rows of a light beside its position and colour, each 16 bytes of every light. ROW(has, feature,
// member): the macro and the member of SceneFeatures of scenes that have the row; xyz of the member
// is a vector, which view space turns, w a number, which it keeps.
#define LIGHT_ROWS(ROW) ROW(HAS_SPOT_LIGHTS, spot_lights, axis_cos)
#define LIGHT_ROW(has, feature, member) float4 member;
// float4 rows of a Light and of a ShadeLight.
#define LIGHT_ROW_COUNT 3

// A point or spot light, camera-relative: world axes, camera at the origin.
SHARED_STRUCT(Light) {
    // xyz: position - camera [m]; w: range about it, whatever the light's size [m], negative unless
    // has_own_range()
    float4 position_range;
    float4 color_scale;  // xyz: luminous intensity, linear Rec. 709 [cd]; w: 1/(cos_in - cos_out)
    // axis_cos: unit spot axis (0 for a point light) and cos_out (-1 for a point light)
    LIGHT_ROWS(LIGHT_ROW)
};
SHARED_ASSERT(light_size, sizeof(Light) == 16 * LIGHT_ROW_COUNT);

// A point light's rows. Its cone is everything: axis 0 and cosine -1 make the cone term exactly 1.
SHARED_FN Light point_light_rows(float4 position_range, float4 intensity) {
    Light light;
    light.position_range = position_range;
    light.color_scale = make_float4(intensity.x, intensity.y, intensity.z, 1.0f);
    light.axis_cos = make_float4(0.0f, 0.0f, 0.0f, -1.0f);
    return light;
}

// Whether its file gives the range; lights without one get a range, see light_ranges.h.
SHARED_FN bool has_own_range(Light light) { return light.position_range.w > 0.0f; }

// A point or spot light in the world: positions as pairs of floats, 48 bits of a double's 53.
SHARED_STRUCT(WorldLight) {
    Light light;          // its position in the world, rounded
    float4 position_low;  // xyz: what rounding lost
};
SHARED_ASSERT(world_light_size, sizeof(WorldLight) == 16 * (LIGHT_ROW_COUNT + 1));

// A light in view space, as shading reads it.
SHARED_STRUCT(ShadeLight) {
    // xyz: p_view [m]; w: 1/range^2 [1/m^2], negative if has_random_range()
    float4 position_inv_range2;
    float4 color_scale;    // as Light
    LIGHT_ROWS(LIGHT_ROW)  // as Light, in view space
};
SHARED_ASSERT(shade_light_size, sizeof(ShadeLight) == 16 * LIGHT_ROW_COUNT);

// Whether the range is a random one: chosen_inv_range2() of light_transform.h.
SHARED_FN bool has_random_range(ShadeLight light) { return light.position_inv_range2.w < 0.0f; }

// A directional light: parallel, never culled.
SHARED_STRUCT(DirectionalLight) {
    float4 to_light;  // xyz: unit direction towards the light; camera-relative world axes from the
                      // host, view space on the device
    float4 color;     // xyz: illuminance, linear Rec. 709 [lx]
};
SHARED_ASSERT(directional_light_size, sizeof(DirectionalLight) == 32);

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
