// SPDX-License-Identifier: Apache-2.0
// Counts the texels that the surfaces of a G-buffer read at least: four for each mip level and each
// sample along a footprint; a texture that several uses read counts once. For limits; no part of a
// frame otherwise.
// One work-item counts for VW neighbouring pixels of a row.
#include "kernels/device/arguments.h"
#include "kernels/device/triangle.h"
#include "kernels/shared/surface_of.h"

#if HAS_TEXCOORD0 || HAS_TEXCOORD1
static inline UV texels_of_lookup(Lookup at) {
    MASK two_levels = lane_mask(at.coarser_share > fv(0.0f));
    return select((UV)(4u), (UV)(8u), two_levels);
}

static inline UV texels_of_use(Map map, Footprint at) {
#if MAX_ANISOTROPY > 1
    if (is_anisotropic(map)) {
        Samples s = samples_along(map, at);
        return texels_of_lookup(make_lookup(map, at.u, at.v, s.lambda)) * lane_to_uint(s.count);
    }
#endif
    return texels_of_lookup(lookup_isotropic(map, at));
}

// Whether an earlier use reads the texture, too.
static inline bool is_read(global const SurfaceMaterial* material, uint use) {
    for (uint i = 0; i < use; ++i) {
        if (HAS_USE(i) && material->textures[i] == material->textures[use]) return true;
    }
    return false;
}

static inline UV texels_of_material(SurfaceScene scene, uint number, const Fragment* f) {
    MaterialRef material = scene.materials + number;
    UV texels = (UV)(0u);
    for (uint use = 0; use < USE_COUNT; ++use) {
        if (!HAS_USE(use) || material->textures[use] == SURFACE_ABSENT) continue;
        if (is_read(material, use)) continue;
        texels += texels_of_use(map_of(textures_of_scene(scene), material, use),
                                footprint_of(material, f, use));
    }
    return texels;
}
#else
static inline UV texels_of_material(SurfaceScene scene, uint material, const Fragment* f) {
    return (UV)(0u);
}
#endif

// ids: [height][stride], triangle + 1; 0 for background. counts: likewise.
kernel void count_texels(global const uint* restrict ids, View view, SCENE_ARGS,
                         global uint* restrict counts) {
    ItemPlace at = place_in_planes(view);
    if (!at.inside) return;
    Pixels pixels = row_pixels(view, at.x, at.y);
    UV id = lane_load(ids + pixels.first);
    MASK shown = lane_mask(id != (UV)(0u)) & within_width(view, pixels);
    UV count = (UV)(0u);
    if (lane_any(shown)) {
        SurfaceScene scene = SCENE_OF_ARGS;
        Fragment fragment = interpolate_fragment(scene, view, pixels, id, shown);
        for (MASK left = shown; lane_any(left);) {
            uint material = first_of(fragment.material, left);
            MASK mask = lane_mask(fragment.material == (UV)(material)) & left;
            count = select(count, texels_of_material(scene, material, &fragment), mask);
            left &= ~mask;
        }
    }
    lane_store(count, counts + pixels.first);
}
