// SPDX-License-Identifier: Apache-2.0
// The photometric web of a light: the share of its largest intensity that it sends each way.
// A table's values are bilinear in vertical and horizontal angle (photometry of type C, ANSI/IES
// LM-63). It begins with a head of PROFILE_HEAD floats, then come its rows of equal steps:
//   0: first vertical angle [rad]   1: rows per radian   2: last row
//   3: steps of a whole turn; 0: the same all around
//   rows of (steps of a turn + 1) shares, from 0 to 1
// OpenCL C and C++ read tables through pointers; a GLSL shader that includes this defines
// profile_of_light(), profile_head() and profile_value().
#ifndef KILOLUX_SHARED_LIGHT_PROFILE_H
#define KILOLUX_SHARED_LIGHT_PROFILE_H
#include "kernels/shared/angle.h"
#include "kernels/shared/types.h"

#ifndef HAS_LIGHT_PROFILES
#define HAS_LIGHT_PROFILES 0
#endif

#define PROFILE_HEAD 4u
#define NO_WEB (-1.0f)
// A web that ends at a vertical angle extends so far beyond it [rad]: five roundings of the angle.
#define PROFILE_EDGE 1e-6f

#if defined(__OPENCL_C_VERSION__) || defined(__OPENCL_VERSION__)
#define HAS_PROFILE_POINTER 1
#define PROFILE_POINTER(type) global const type*
#elif defined(__cplusplus)
#define HAS_PROFILE_POINTER 1
#define PROFILE_POINTER(type) const type*
#else
#define HAS_PROFILE_POINTER 0
#endif

#if defined(__cplusplus)
namespace kilolux {
#endif

// The web of a light and its orientation, in the axes of the light's position.
SHARED_STRUCT(AimedProfile) {
    // xyz: unit direction of vertical angle 0; w: first float of the table, exact below 2^24, or
    // NO_WEB
    float4 down;
    // xyz: unit direction of vertical angle 90 and horizontal angle 0; w: 1, or -1 where a mirrored
    // node turns horizontal angles the other way
    float4 side;
};
SHARED_ASSERT(aimed_profile_size, sizeof(AimedProfile) == 32);

// The first float of its web's table, or NO_WEB.
SHARED_FN float web_start(AimedProfile aim) { return aim.down.w; }

// Whether the light has a web; without one it sends its intensity all around.
SHARED_FN bool has_web(AimedProfile aim) { return web_start(aim) != NO_WEB; }

// 1, or -1 if the light's node mirrors its web.
SHARED_FN float web_handedness(AimedProfile aim) { return aim.side.w; }

#if HAS_PROFILE_POINTER
SHARED_PLAIN_STRUCT(LightProfiles) {
    PROFILE_POINTER(AimedProfile) lights;  // [light_count]
    PROFILE_POINTER(float) tables;
};

SHARED_FN AimedProfile profile_of_light(LightProfiles from, uint light) {
    return from.lights[light];
}

SHARED_FN float profile_head(LightProfiles from, uint i) { return from.tables[i]; }

SHARED_FN FV profile_value(LightProfiles from, UV i) {
#if defined(__cplusplus)
    return from.tables[i];
#else
    FV values;
    float* lanes = (float*)&values;
    const uint* index = (const uint*)&i;
    for (uint lane = 0; lane < VW; ++lane) lanes[lane] = from.tables[index[lane]];
    return values;
#endif
}
#else
struct LightProfiles {
    uint unused0;
};
AimedProfile profile_of_light(LightProfiles from, uint light);
float profile_head(LightProfiles from, uint i);
float profile_value(LightProfiles from, uint i);
#endif

// A GLSL shader of a scene without webs defines none of what reads them.
#if HAS_PROFILE_POINTER || HAS_LIGHT_PROFILES
// Bilinear between the table's values around (row, column).
SHARED_FN FV profile_between(LightProfiles from, uint values, FV row, FV column, float last_row,
                             float turn) {
    FV r = min(floor(row), fv(last_row - 1.0f));
    FV below = row - r;
    FV width = fv(turn + 1.0f);
    if (turn == 0.0f) {
        UV at = lane_uint(values) + lane_truncate(r);
        FV a = profile_value(from, at);
        return fma(below, profile_value(from, at + lane_uint(1u)) - a, a);
    }
    FV c = min(floor(column), fv(turn - 1.0f));
    FV beside = column - c;
    UV at = lane_uint(values) + lane_truncate(fma(r, width, c));
    UV next = at + lane_truncate(width);
    FV a = profile_value(from, at);
    FV b = profile_value(from, next);
    a = fma(beside, profile_value(from, at + lane_uint(1u)) - a, a);
    b = fma(beside, profile_value(from, next + lane_uint(1u)) - b, b);
    return fma(below, b - a, a);
}

// The share that a light sends to a point; `to_light`: from the point to the light, of any length.
SHARED_FN FV profile_share(LightProfiles from, uint light, FV3 to_light) {
    AimedProfile aim = profile_of_light(from, light);
    if (!has_web(aim)) return fv(1.0f);
    FV3 down = fv3(fv(aim.down.x), fv(aim.down.y), fv(aim.down.z));
    FV3 side = fv3(fv(aim.side.x), fv(aim.side.y), fv(aim.side.z));
    FV along = -dot3(to_light, down);
    FV x = -dot3(to_light, side);
    FV y = -dot3(to_light, cross3(side, down)) * fv(web_handedness(aim));
    uint head = uint_of(web_start(aim));
    float first = profile_head(from, head);
    float per_radian = profile_head(from, head + 1u);
    float last_row = profile_head(from, head + 2u);
    float turn = profile_head(from, head + 3u);
    FV angle = half_turn_angle(along, lane_sqrt(fma(x, x, y * y))) - fv(first);
    FV row = min(max(angle * fv(per_radian), fv(0.0f)), fv(last_row));
    FV column = fv(0.0f);
    if (turn != 0.0f) {
        FV around = half_turn_angle(x, max(y, -y));
        around = lane_select(y < fv(0.0f), fv(6.283185307f) - around, around);
        column = min(around * fv(turn * 0.1591549431f), fv(turn));
    }
    FV share = profile_between(from, head + PROFILE_HEAD, row, column, last_row, turn);
    share = lane_select(angle < fv(-PROFILE_EDGE), fv(0.0f), share);
    float end = last_row / per_radian + PROFILE_EDGE;
    return lane_select(angle > fv(end), fv(0.0f), min(max(share, fv(0.0f)), fv(1.0f)));
}
#endif

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
