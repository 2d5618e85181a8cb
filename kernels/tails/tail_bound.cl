// SPDX-License-Identifier: Apache-2.0
// Bounds the radiance that each pixel lacks since lights without a range got one, from the moments
// of its coarse cluster (tail_moments). One work-item bounds one pixel: VW is 1.
//
// Of the light from directions l with weights w, the surface takes sum w max(n.l, 0) = sum w (|n.l|
// + n.l) / 2, and sum w |n.l| <= sqrt(sum w * sum w (n.l)^2) by Cauchy and Schwarz. Directions
// stray by s within a cluster, which adds sum w s.
#include "kernels/device/lit_item.h"
#include "kernels/device/radiance.h"
#include "kernels/lists/coarse_tile.h"
#include "kernels/shared/evaluate.h"
#include "kernels/tails/tail_moments.h"

// sum of w max(n.l, 0) of one colour, at most.
static inline float irradiance_bound(global const float* m, FV3 n) {
    global const float* to = m + TAIL_TO;
    global const float* outer = m + TAIL_OUTER;
    float along = n.x * to[0] + n.y * to[1] + n.z * to[2];
    float square = n.x * n.x * outer[0] + n.y * n.y * outer[1] + n.z * n.z * outer[2] +
                   2.0f * (n.x * n.y * outer[3] + n.x * n.z * outer[4] + n.y * n.z * outer[5]);
    float both = sqrt(m[TAIL_AIMED] * max(square, 0.0f));
    // Rounding may have changed the difference by as much as its terms.
    return 0.5f * (both + along) + BOUND_ROUNDING * m[TAIL_AIMED] + m[TAIL_STRAY];
}

kernel void tail_bound(GBUFFER_ARGS, ClusterGrid grid,
                       global const float* restrict moments,  // [cluster_count][TAIL_ROWS]
                       global float* restrict bound) {        // out [3][height][stride]
    BEGIN_ROW;
    if (!item.any) {
        store_radiance(bound, view, item.pixels, zero3());
        return;
    }
    Surface s = load_surface(g, item.pixels, item.z);
    ShadingPoint p = make_shading_point(s, view.orthographic != 0u);
    CoarseTile tile = coarse_tile(view, grid, at.tile);
    uint cluster = cluster_index(grid, tile.column, tile.row, slice_of_depth(grid, item.z));
    global const float* m = moments + cluster * TAIL_ROWS;
    float irradiance[3], all[3];
    for (uint c = 0; c < 3; ++c) {
        irradiance[c] = irradiance_bound(m + c * TAIL_MOMENTS, s.normal);
        all[c] = m[c * TAIL_MOMENTS + TAIL_ALL];
    }
    FV3 received = fv3(irradiance[0], irradiance[1], irradiance[2]);
    // The directions are unknown: n.h and Schlick's (1 - v.h)^5 are 1 at most.
    LightBound most = {1.0f, 1.0f, received, fv3(all[0], all[1], all[2]), received};
    LightSum sum = add_bounds(zero_sum(), s, p, most);
    store_radiance(bound, view, item.pixels, radiance_bound(s, p, sum));
}
