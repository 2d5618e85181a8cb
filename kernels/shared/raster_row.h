// SPDX-License-Identifier: Apache-2.0
// A triangle as raster_triangles draws it: affine functions of a pixel's ray, one cache line.
#ifndef KILOLUX_SHARED_RASTER_ROW_H
#define KILOLUX_SHARED_RASTER_ROW_H
#include "kernels/shared/types.h"
#if defined(__cplusplus)
namespace kilolux {
#endif

SHARED_STRUCT(RasterRow) {
    float edge[9];   // three times x, y, z: scaled and positive inside, see raster_triangle.h
    float plane[3];  // key = plane[0] ray.x + plane[1] ray.y - plane[2]
    float farthest;  // of the vertices' keys
    float nearest;   // infinite behind the eye
    uint columns;    // pixels of the planes that it may cover: first | last << 16
    uint rows;
};
SHARED_ASSERT(raster_row_size, sizeof(RasterRow) == 64);

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
