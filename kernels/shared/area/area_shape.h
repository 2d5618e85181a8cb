// SPDX-License-Identifier: Apache-2.0
// The shape of a light with a size. Such a light has the same luminance everywhere. Its row in
// light.h is that of a point at its centre. color_scale.xyz: intensity straight ahead [cd] =
// luminance * projected area.
#ifndef KILOLUX_SHARED_AREA_AREA_SHAPE_H
#define KILOLUX_SHARED_AREA_AREA_SHAPE_H
#include "kernels/shared/types.h"

// Kinds: no size; a rectangle; an ellipse with the half axes half_x and half_y; a sphere, half_x as
// long as its radius; the triangle about its centroid with the edges half_x and half_y from its
// first corner.
#define SHAPE_POINT 0u
#define SHAPE_RECTANGLE 1u
#define SHAPE_DISK 2u
#define SHAPE_SPHERE 3u
#define SHAPE_TRIANGLE 4u

#if defined(__cplusplus)
namespace kilolux {
#endif

// Beside a light's row, of scenes that have such lights; in the axes of the light's position. A
// triangle's half_x and half_y are its full edges.
SHARED_STRUCT(LightShape) {
    float4 half_x;  // xyz: along the width [m]; w: SHAPE_*, negative if both sides shine
    // xyz: along the height [m]; w: 1 / the area that is seen from straight ahead [1/m^2].
    // Flat shapes shine to the side that half_x x half_y points to.
    float4 half_y;
};
SHARED_ASSERT(light_shape_size, sizeof(LightShape) == 32);

// SHAPE_*.
SHARED_FN uint shape_kind(LightShape shape) {
    float kind = shape.half_x.w;
    return uint_of(kind < 0.0f ? -kind : kind);
}

SHARED_FN bool has_size(LightShape shape) { return shape_kind(shape) != SHAPE_POINT; }

SHARED_FN bool shines_both_ways(LightShape shape) { return shape.half_x.w < 0.0f; }

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
