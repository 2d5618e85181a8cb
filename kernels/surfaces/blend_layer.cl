// SPDX-License-Identifier: Apache-2.0
// Lays a lit layer over the light behind it: alpha * layer + (1 - alpha) * behind, alpha as
// alphaMode BLEND has it, limited to 0 to 1. Alpha 0 and 1 keep the bits of one of the two. One
// work-item has VW neighbours of a row.
#include "kernels/device/arguments.h"
#include "kernels/device/radiance.h"
#include "kernels/surfaces/alpha_mask.h"

static inline FV alpha_of_layer(SurfaceScene scene, View view, Pixels pixels, UV ids, MASK shown) {
    FV alpha = fv(0.0f);
    for (MASK left = shown; lane_any(left);) {
        uint id = first_of(ids, left);
        MASK mask = lane_mask(ids == (UV)(id)) & shown;
        MaskedTriangle t = fetch_masked_triangle(scene, view, id - 1u);
        FV own = material_alpha(scene, view, &t, pixels);
        alpha = lane_select(mask, min(max(own, fv(0.0f)), fv(1.0f)), alpha);
        left &= ~mask;
    }
    return alpha;
}

// Where alpha is 0 or 1 the other light counts for nothing, infinite or not.
static inline FV blended(FV alpha, FV layer, FV behind) {
    FV mixed = fma(alpha, layer, (fv(1.0f) - alpha) * behind);
    mixed = lane_select(lane_mask(alpha == fv(0.0f)), behind, mixed);
    return lane_select(lane_mask(alpha == fv(1.0f)), layer, mixed);
}

kernel void blend_layer(View view, SCENE_ARGS,
                        global const uint* restrict ids,  // [height][stride]: triangle + 1; 0: none
                        global const float* restrict layer,  // [3][height][stride]
                        global float* restrict radiance) {   // in, out [3][height][stride]
    ItemPlace at = place_in_planes(view);
    if (!at.inside) return;
    Pixels pixels = row_pixels(view, at.x, at.y);
    UV id = lane_load(ids + pixels.first);
    MASK shown = lane_mask(id != (UV)(0u));
    if (!lane_any(shown)) return;
    SurfaceScene scene = SCENE_OF_ARGS;
    FV alpha = alpha_of_layer(scene, view, pixels, id, shown);
    FV3 over = load_radiance(layer, view, pixels);
    FV3 behind = load_radiance(radiance, view, pixels);
    FV3 mixed = fv3(blended(alpha, over.x, behind.x), blended(alpha, over.y, behind.y),
                    blended(alpha, over.z, behind.z));
    store_radiance(radiance, view, pixels, select3(shown, mixed, behind));
}
