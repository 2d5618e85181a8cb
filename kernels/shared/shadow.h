// SPDX-License-Identifier: Apache-2.0
// Shadow casters: triangles and the hierarchy of their boxes, in shadow space.
//
// Shadow space has the world's axes and its origin at an anchor near the scene's middle. So camera
// and lights do not move it, and the scene's size alone sets the rounding of its floats.
#ifndef KILOLUX_SHARED_SHADOW_H
#define KILOLUX_SHARED_SHADOW_H
#include "kernels/shared/evaluate_modes.h"
#include "kernels/shared/types.h"

// Children of a node: boxes are tested so many at a time.
#define SHADOW_WIDTH 16
// Levels of nodes at most, and the stack that a walk needs for them.
#define SHADOW_LEVELS 32
#define SHADOW_STACK (SHADOW_LEVELS * (SHADOW_WIDTH - 1) + 1)

// Bits of a child's number. SHADOW_LEAF: it is a triangle, else a node. The other one: alpha cuts
// it, and the number is that of a MaskedCaster; in the second hierarchy that of a TintCaster.
#define SHADOW_LEAF (1u << 31)
#define SHADOW_MASKED (1u << 30)
#define SHADOW_NUMBER (SHADOW_MASKED - 1u)

// Boxes are wider than their triangles by this share of the largest coordinate [m/m]: more than the
// tolerance of kernels/shadows/shadow_triangle.h beyond a triangle's edges.
#define SHADOW_PAD (1.0f / (1 << 17))

// Most rays of a pixel for one lobe of one light with a size.
#define AREA_SLOTS_MOST 1024u

// Ends of the box of a missing child, which no shaft meets.
#define SHADOW_NOWHERE 1e30f

#if defined(__cplusplus)
namespace kilolux {
#endif

// 16 boxes [m] by their ends, and their contents.
SHARED_STRUCT(ShadowNode) {
    float low_x[SHADOW_WIDTH];
    float low_y[SHADOW_WIDTH];
    float low_z[SHADOW_WIDTH];
    float high_x[SHADOW_WIDTH];
    float high_y[SHADOW_WIDTH];
    float high_z[SHADOW_WIDTH];
    uint child[SHADOW_WIDTH];
};
SHARED_ASSERT(shadow_node_size, sizeof(ShadowNode) == 448);

// A triangle with an alpha mask (glTF's MASK).
SHARED_STRUCT(MaskedCaster) {
    float u[3], v[3];  // texture coordinates of the vertices, in the set that the base colour reads
    float alpha[3];    // of the vertices' colours
    uint triangle;     // among the casters
    uint material;     // row
    uint unused0;
};
SHARED_ASSERT(masked_caster_size, sizeof(MaskedCaster) == 48);

// A triangle of a surface that blends or transmits: what its vertices have.
SHARED_STRUCT(TintCaster) {
    float u0[3], v0[3], u1[3], v1[3];  // both sets of texture coordinates
    float red[3], green[3], blue[3], alpha[3];
    uint triangle;  // among the casters
    uint material;  // row
    float scale;    // root mean square of its instance's scales; negative where it mirrors
    uint unused0;
};
SHARED_ASSERT(tint_caster_size, sizeof(TintCaster) == 112);

// From view space to shadow space.
SHARED_STRUCT(ShadowView) {
    float4 shadow_from_view[3];  // xyz: a row of the rotation; w: of the camera's position [m]
    float extent;                // no caster's |x| + |y| + |z| is larger [m]
    uint levels;                 // of the hierarchy; 0: not known
    uint tint_root;  // node 0 of a second hierarchy, of surfaces that tint light; 0: there are none
    uint unused0;
};
SHARED_ASSERT(shadow_view_size, sizeof(ShadowView) == 64);

// Slots of one lobe of a light with a size: the most rays that a pixel casts to it, an even number.
// 1 without sampling. rays: of a pixel on average, 0 without sampling.
SHARED_FN uint lobe_slots(float rays) {
    if (rays <= 0.0f) return 1u;
    uint pairs = uint_of(min(fma(rays, 0.5f, 0.999f), float_of(AREA_SLOTS_MOST / 2u)));
    return 2u * max(pairs, 1u);
}

// Lobes of a light with a size that have rays of their own, by SHADING: diffuse and, with
// SHADING_PBR, glossy.
#define AREA_LOBES_OF(shading) ((shading) == SHADING_PBR ? 2u : 1u)

// Slots of a light of a list in scenes with area lights: for the rays of its lobes; then one for
// each lobe, whose bits say which pixels may pick it (shadows/shadow_candidates.h). 1 with 0 lobes.
SHARED_FN uint slots_of_light(uint lobes, float rays) {
    return max(lobes * (lobe_slots(rays) + 1u), 1u);
}

#if !defined(GL_core_profile)  // GLSL has no 64-bit integers
// The work of casting shadows, counted by kernels with COUNT_SHADOWS.
SHARED_STRUCT(ShadowCounts) {
    ulong shafts;     // walks
    ulong rays;       // points of the walks: they face the light within its range
    ulong met_rays;   // those of them that a triangle may hide, after tests of the whole shaft
    ulong seen;       // those rays that nothing hides
    ulong nodes;      // visited
    ulong triangles;  // set up
    ulong points;     // lit ones, once for each triangle that they are tested against
    ulong words;      // of 32 bits that hold the results; set by the host
};
SHARED_ASSERT(shadow_counts_size, sizeof(ShadowCounts) == 64);
#endif

#if defined(__cplusplus)
inline ShadowCounts operator+(const ShadowCounts& a, const ShadowCounts& b) {
    return {a.shafts + b.shafts, a.rays + b.rays,   a.met_rays + b.met_rays,
            a.seen + b.seen,     a.nodes + b.nodes, a.triangles + b.triangles,
            a.points + b.points, a.words + b.words};
}
#endif

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
