// SPDX-License-Identifier: Apache-2.0
// The camera as kernels see it: where a pixel with a depth lies in view space.
#ifndef KILOLUX_SHARED_VIEW_H
#define KILOLUX_SHARED_VIEW_H
#include "kernels/shared/types.h"
#if defined(__cplusplus)
namespace kilolux {
#endif

// View space: camera at the origin, -Z forward, +Y up; depth z = -p_view.z [m]. Pixel (0,0) is the
// image's upper left; a pixel's centre is at +0.5. depth01 is the reversed-Z depth buffer value:
// 0 where nothing was drawn, larger is nearer.
//
// Perspective:   x_view = (px * ray.x + ray.y) * z,  y_view = (py * ray.z + ray.w) * z,
//                1/z    = depth01 * depth.x + px * depth.y + py * depth.z + depth.w
// Orthographic:  x_view =  px * ray.x + ray.y,       y_view =  py * ray.z + ray.w,
//                z      = depth01 * depth.x + px * depth.y + py * depth.z + depth.w
// depth.y and depth.z are 0 unless the near plane is oblique: 1/z is linear in screen space.
// Planes may hold a rectangle of the picture only, and several layers of it, one below the other:
// see picture_column() and picture_row(). px and py count in the picture, so that a pixel has the
// same bits in whatever planes it lies.
SHARED_STRUCT(View) {
    float4 ray;
    float4 depth;
    uint width;         // [pixel]
    uint height;        // rows of the planes [pixel]
    uint stride;        // pixels from a row to the next in every plane: width rounded up to 16
    uint orthographic;  // 0 or 1
    float4 view_from_world_x;  // xyz: row x of the rotation, for camera-relative positions
    float4 view_from_world_y;
    float4 view_from_world_z;
    float4 camera_position;  // xyz: world [m]; only layouts that store world positions need it
    uint first_row;     // of the picture, where the planes begin; `height` counts the planes' rows
    uint first_column;  // likewise; a multiple of 16; 0 in planes that OpenGL draws
    uint layer_mask;    // bits of y that number the layer, of a power of two of rows; 0: one layer
    uint unused0;
};
SHARED_ASSERT(view_size, sizeof(View) == 128);

// The picture's column and row of column x and row y of the planes.
SHARED_FN uint picture_column(View view, uint x) { return x + view.first_column; }

SHARED_FN uint picture_row(View view, uint y) { return (y & ~view.layer_mask) + view.first_row; }

// The column and row of the planes, in their first layer, of the picture's column x and row y.
SHARED_FN uint plane_column(View view, uint x) { return x - view.first_column; }
SHARED_FN uint plane_row(View view, uint y) { return y - view.first_row; }

SHARED_FN uint rows_of_layer(View view) {
    return view.layer_mask != 0u ? ~view.layer_mask + 1u : view.height;
}
SHARED_FN uint layer_count(View view) { return view.height / rows_of_layer(view); }

// The first `count` layers.
SHARED_FN View first_layers(View view, uint count) {
    view.height = count * rows_of_layer(view);
    return view;
}

// Depth z [m] of a pixel with depth01 at pixel coordinates (px, py), centres at +0.5.
SHARED_FN FV view_depth(View view, FV px, FV py, FV depth01) {
    FV q = fma(depth01, fv(view.depth.x),
               fma(px, fv(view.depth.y), fma(py, fv(view.depth.z), fv(view.depth.w))));
    return view.orthographic != 0u ? q : fv(1.0f) / q;
}

// Position in view space of pixel coordinates (px, py) at depth z [m].
SHARED_FN FV3 view_position(View view, FV px, FV py, FV z) {
    FV rx = fma(px, fv(view.ray.x), fv(view.ray.y));
    FV ry = fma(py, fv(view.ray.z), fv(view.ray.w));
    FV s = view.orthographic != 0u ? fv(1.0f) : z;
    return fv3(rx * s, ry * s, -z);
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
