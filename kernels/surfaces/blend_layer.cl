// SPDX-License-Identifier: Apache-2.0
// Lays lit layers over the light behind them, one after the other:
// alpha * layer + (1 - alpha + alpha * t) * behind, with the alpha of the material and what the
// surface transmits, t. Where alpha is 0, or is 1 with t 0, the result has the bits of one of the
// two. The light of each group of lights is blended alike. One work-item has VW neighbours of a
// row.
#include "kernels/device/arguments.h"
#include "kernels/device/gbuffer.h"
#include "kernels/device/radiance.h"
#include "kernels/shared/evaluate.h"
#include "kernels/surfaces/alpha_mask.h"

static inline FV alpha_of_layer(SurfaceScene scene, View view, Pixels pixels, UV ids, MASK shown) {
    FV alpha = fv(0.0f);
    for (MASK left = shown; lane_any(left);) {
        uint id = first_of(ids, left);
        MASK mask = lane_mask(ids == (UV)(id)) & shown;
        MaskedTriangle t = fetch_masked_triangle(scene, view, id - 1u);
        alpha = lane_select(mask, material_coverage(scene, view, &t, pixels), alpha);
        left &= ~mask;
    }
    return alpha;
}

// A share of 0 gives 0, even of infinite light.
static inline FV blended(FV alpha, FV layer, FV share, FV behind) {
    FV seen = lane_select(lane_mask(share == fv(0.0f)), fv(0.0f), share * behind);
    return lane_select(lane_mask(alpha == fv(0.0f)), behind, fma(alpha, layer, seen));
}

// The share of the light behind that reaches the eye.
static inline FV3 share_of_behind(GBuffer g, Pixels pixels, FV alpha) {
#if HAS_TRANSMISSION
    FV z = view_depth(g.view, pixels.x, pixels.y, load_depth01(g, pixels));
    Surface s = load_surface(g, pixels, z);
    return share_behind(s, make_shading_point(s, g.view.orthographic != 0u), alpha);
#else
    FV bare = fv(1.0f) - alpha;
    return fv3(bare, bare, bare);
#endif
}

kernel void blend_layer(GBUFFER_ARGS, SCENE_ARGS,         // of layers, from far to near
                        global const uint* restrict ids,  // [height][stride]: triangle + 1; 0: none
                        global const float* restrict lit,  // RADIANCE_PLANES
                        View behind,                       // planes that hold the layers' rectangle
                        global float* restrict radiance) {  // in, out RADIANCE_PLANES of them
    ItemPlace at = place_in_planes(view);
    uint rows = rows_of_layer(view);
    if (at.y >= rows) return;
    SurfaceScene scene = SCENE_OF_ARGS;
    Pixels to = row_pixels(behind, plane_column(behind, picture_column(view, at.x)),
                           plane_row(behind, picture_row(view, at.y)));
    // Loads and stores only where a layer covers a pixel: rows may lie below the picture.
    bool has_light = false;
    FV3 light[1 + LIGHT_GROUPS];  // the whole, and the groups'
    for (uint y = at.y; y < view.height; y += rows) {
        Pixels pixels = row_pixels(view, at.x, y);
        UV id = lane_load(ids + pixels.first);
        MASK shown = lane_mask(id != (UV)(0u));
        if (!lane_any(shown)) continue;
        for (uint i = 0; !has_light && i <= LIGHT_GROUPS; ++i) {
            light[i] = load_radiance(radiance + group_planes(behind, i), behind, to);
        }
        has_light = true;
        FV alpha = alpha_of_layer(scene, view, pixels, id, shown);
        FV3 share = share_of_behind((GBuffer){gbuffer, layout, view, srgb}, pixels, alpha);
        for (uint i = 0; i <= LIGHT_GROUPS; ++i) {
            FV3 over = load_radiance(lit + group_planes(view, i), view, pixels);
            FV3 mixed = fv3(blended(alpha, over.x, share.x, light[i].x),
                            blended(alpha, over.y, share.y, light[i].y),
                            blended(alpha, over.z, share.z, light[i].z));
            light[i] = select3(shown, mixed, light[i]);
        }
    }
    for (uint i = 0; has_light && i <= LIGHT_GROUPS; ++i) {
        store_radiance(radiance + group_planes(behind, i), behind, to, light[i]);
    }
}
