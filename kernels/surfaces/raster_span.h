// SPDX-License-Identifier: Apache-2.0
// Finds the columns that a triangle touches in rows of pixels, by the zeros of its edges: rows in
// lanes.
#ifndef KILOLUX_DEVICE_RASTER_SPAN_H
#define KILOLUX_DEVICE_RASTER_SPAN_H
#include "kernels/surfaces/raster_triangle.h"

// Columns [pixel] of VW rows; first > last: none.
typedef struct RowSpans {
    FV first, last;
} RowSpans;

// The part in which one edge's function, `start` at column 0 and `step` more at each next, can be
// positive. The quotient errs by less than 1/32 of a pixel.
static inline RowSpans cut_spans(RowSpans s, float step, FV start) {
    if (fabs(step) < 1e-12f) {  // constant within the error
        s.last = lane_select(lane_mask(start < fv(0.0f)), fv(-1.0f), s.last);
        return s;
    }
    FV zero = start * fv(-1.0f / step);
    if (step > 0.0f) {
        s.first = max(s.first, zero - fv(0.03125f));
    } else {
        s.last = min(s.last, zero + fv(0.03125f));
    }
    return s;
}

// The part that a triangle can cover in rows of pixels. Several make one row of spans: `top` and
// `bottom` are the rays' y of its first and last. `ray_x`: the ray's x at column 0.
static inline RowSpans touched_spans(View view, global const RasterRow* t, float ray_x, FV top,
                                     FV bottom, RowSpans s) {
#pragma unroll
    for (uint e = 0; e < 3; ++e) {
        float across = t->edge[3 * e];
        FV down = fv(t->edge[3 * e + 1]);
        // The function errs by less than 1 here, and by less than 1 at a pixel.
        float rest = fma(across, ray_x, 2.0f - t->edge[3 * e + 2]);
        s = cut_spans(s, across * view.ray.x, max(down * top, down * bottom) + fv(rest));
    }
    return s;
}
#endif
