// SPDX-License-Identifier: Apache-2.0
// The shadow casters of a scene.
#ifndef KILOLUX_DEVICE_SHADOW_SCENE_H
#define KILOLUX_DEVICE_SHADOW_SCENE_H
#include "kernels/shadows/masked_caster.h"
#include "kernels/shadows/shadow_points.h"

typedef struct ShadowScene {
    global const ShadowNode* nodes;  // 0: the root
    global const float* casters;     // [][3][3]
    MaskedScene masked;
    ShadowView view;
#if TINTED_SHADOWS
    bool tints;  // the triangles tint light and hide no points
    global const TintCaster* tint_casters;
#endif
} ShadowScene;
#define SHADOW_SCENE_OF_ARGS \
    ((ShadowScene){shadow_nodes, casters, {masked_casters, materials, {textures, texels}}, shadow})

#if TINTED_SHADOWS
// The surfaces that tint light, of the same casters.
static inline ShadowScene tinting_scene(ShadowScene scene, global const TintCaster* casters) {
    scene.tint_casters = casters;
    scene.nodes += scene.view.tint_root;
    scene.tints = true;
    return scene;
}
#endif

static inline uint lowest_bit(uint bits) { return 31u - clz(bits & -bits); }

static inline uint caster_of(ShadowScene scene, uint child) {
    uint number = child & SHADOW_NUMBER;
#if TINTED_SHADOWS
    if (scene.tints) return scene.tint_casters[number].triangle;
#endif
#if HAS_MASKED_CASTERS
    if ((child & SHADOW_MASKED) != 0u) return scene.masked.casters[number].triangle;
#endif
    return number;
}

// Corners of VW triangles.
static inline void load_casters(ShadowScene scene, const uint* children, FV3* v) {
    float corner[9][VW];
#pragma unroll
    for (uint lane = 0; lane < VW; ++lane) {
        global const float* t = scene.casters + (ulong)caster_of(scene, children[lane]) * 9u;
        for (uint i = 0; i < 9; ++i) corner[i][lane] = t[i];
    }
    for (uint i = 0; i < 3; ++i) {
        v[i] = fv3(lane_load(corner[3 * i]), lane_load(corner[3 * i + 1]),
                   lane_load(corner[3 * i + 2]));
    }
}
#endif
