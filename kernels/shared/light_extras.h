// SPDX-License-Identifier: Apache-2.0
// Rows beside a light's own, by the light's index, that only some pictures need: photometric webs
// (HAS_LIGHT_PROFILES), shapes (HAS_AREA_LIGHTS) and groups (LIGHT_GROUPS).
// OpenCL C and C++ read them through pointers; a GLSL shader that includes this defines
// shape_of_light() and what light_profile.h asks for.
#ifndef KILOLUX_SHARED_LIGHT_EXTRAS_H
#define KILOLUX_SHARED_LIGHT_EXTRAS_H
#include "kernels/shared/area/area_shape.h"
#include "kernels/shared/light_profile.h"

#if defined(__cplusplus)
namespace kilolux {
#endif

#if HAS_PROFILE_POINTER
SHARED_PLAIN_STRUCT(LightExtras) {
    LightProfiles profiles;
    PROFILE_POINTER(LightShape) shapes;  // [light_count]
    PROFILE_POINTER(uchar) groups;       // [light_count], then the directional lights'; 0: none
};

SHARED_FN LightShape shape_of_light(LightExtras from, uint light) { return from.shapes[light]; }
#else
struct LightExtras {
    LightProfiles profiles;
};
LightShape shape_of_light(LightExtras from, uint light);
#endif

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
