// SPDX-License-Identifier: Apache-2.0
// Visibility of one light at up to SHADOW_POINTS points: one work-item walks through the hierarchy
// once for all of them, and tests the triangles that their shaft meets on VW points at a time.
#ifndef KILOLUX_DEVICE_SHADOW_CAST_H
#define KILOLUX_DEVICE_SHADOW_CAST_H
#include "kernels/device/prefetch.h"
#include "kernels/shadows/area_cast.h"
#include "kernels/shadows/masked_caster.h"
#include "kernels/shadows/shadow_points.h"
#include "kernels/shadows/shadow_scene.h"
#include "kernels/shadows/shadow_shaft.h"

// Most triangles that wait for their test: whole vectors, and room for a node's children.
#define SHADOW_BATCH 64

// The forms of VW triangles: g.x, g.y, g.z, c of the three edges and of the plane, each in all
// lanes; the edges' units; and the boxes' middles and half edges.
#define FORM_ROWS 25
typedef struct FormRows {
    float of[FORM_ROWS][VW];
} FormRows;

static inline void store_form(ShadowForm form, FormRows* to, uint row) {
    lane_store(form.g.x, to->of[row]);
    lane_store(form.g.y, to->of[row + 1]);
    lane_store(form.g.z, to->of[row + 2]);
    lane_store(form.c, to->of[row + 3]);
}

static inline void store_forms(const ShadowTriangles* t, FormRows* to) {
    for (uint i = 0; i < 3; ++i) {
        store_form(t->edge[i], to, 4 * i);
        lane_store(t->unit[i], to->of[16 + i]);
    }
    store_form(t->plane, to, 12);
    lane_store(t->box.middle.x, to->of[19]);
    lane_store(t->box.middle.y, to->of[20]);
    lane_store(t->box.middle.z, to->of[21]);
    lane_store(t->box.half_edge.x, to->of[22]);
    lane_store(t->box.half_edge.y, to->of[23]);
    lane_store(t->box.half_edge.z, to->of[24]);
}

// Three rows of triangle `lane`.
static inline FV3 row3_of(const FormRows* forms, uint row, uint lane) {
    return fv3(fv(forms->of[row][lane]), fv(forms->of[row + 1][lane]),
               fv(forms->of[row + 2][lane]));
}

// A form of triangle `lane` at points.
static inline FV form_at(const FormRows* forms, uint row, uint lane, FV3 x) {
    return fma(fv(forms->of[row][lane]), x.x,
               fma(fv(forms->of[row + 1][lane]), x.y,
                   fma(fv(forms->of[row + 2][lane]), x.z, fv(forms->of[row + 3][lane]))));
}

// The triangles of one vector that are tested.
typedef struct FoundTriangles {
    FormRows forms;
    uint wanted;           // a bit for each
    const uint* children;  // [VW]
} FoundTriangles;

// The part of `lit`, of a row's points, that none of the triangles hides from the light.
static inline MASK lit_by_row(const FoundTriangles* found, ShadowScene scene, ShadowLight light,
                              ShadowPoints* points, uint row, MASK lit) {
    FV3 edge_point = load_ray_ends(points, row);
    FV3 point = load_points(points, row);
    for (uint bits = found->wanted; bits != 0u; bits &= bits - 1u) {
        uint lane = lowest_bit(bits);
        FV u0 = form_at(&found->forms, 0, lane, edge_point);
        FV u1 = form_at(&found->forms, 4, lane, edge_point);
        FV u2 = form_at(&found->forms, 8, lane, edge_point);
        FV behind = form_at(&found->forms, 12, lane, point);
        MASK shaded = lane_mask(min(min(u0, u1), min(u2, behind)) >= fv(-1.0f)) & lit;
        if (!lane_any(shaded)) continue;
        LaneBoxes box = {row3_of(&found->forms, 19, lane), row3_of(&found->forms, 22, lane)};
        shaded &= passes_box(shared_light(light), point, box);
#if TINTED_SHADOWS || HAS_MASKED_CASTERS
        uint child = found->children[lane];
        CasterWeights w =
            caster_weights(u0 * found->forms.of[16][lane], u1 * found->forms.of[17][lane],
                           u2 * found->forms.of[18][lane]);
#endif
#if TINTED_SHADOWS
        if (scene.tints) {
            TintRay ray = {{u0, u1, u2}, w, splat3(light.at)};
            if (!light.is_direction) ray.to_light = sub3(ray.to_light, point);
            global const TintCaster* caster = scene.tint_casters + (child & SHADOW_NUMBER);
            points->tints =
                add_surface(points->tints, scene.masked, scene.casters, caster, ray, shaded);
            continue;
        }
#endif
#if HAS_MASKED_CASTERS
        if ((child & SHADOW_MASKED) != 0u) {
            shaded &= is_opaque_at(scene.masked, child & SHADOW_NUMBER, w);
        }
#endif
        lit &= ~shaded;
    }
    return lit;
}

static inline void shade_rows(ShadowPoints* points, const FoundTriangles* found, ShadowScene scene,
                              ShadowLight light) {
    uint count = 0;
    for (uint i = 0; i < points->row_count; ++i) {
        uint row = points->rows[i];
        MASK lit = lit_of(points, row);
        ADD_COUNT(points, points, popcount(found->wanted) * lane_count(lit));
        lit = lit_by_row(found, scene, light, points, row, lit);
        lane_store(KX_CONCAT(as_, FV)(lit), points->lit + row * VW);
        points->rows[count] = (uchar)row;
        count += lane_any(lit) ? 1u : 0u;
    }
    points->row_count = count;
}

// Lists the rows that still have lit points.
static inline void find_lit_rows(ShadowPoints* points, uint first, uint end) {
    uint count = 0;
    for (uint row = first; row < end; ++row) {
        points->rows[count] = (uchar)row;
        count += lane_any(lit_of(points, row)) ? 1u : 0u;
    }
    points->row_count = count;
}

// Tests the triangles that the walk found. `found` has room for whole vectors.
static inline void shade_found(ShadowScene scene, ShadowLight light, Shaft shaft, uint* found,
                               uint count, ShadowPoints* points) {
    ADD_COUNT(points, triangles, count);
    for (uint i = count; i < (count + VW - 1) / VW * VW; ++i) found[i] = found[count - 1];
#if AREA_SHADOWS
    if (light.is_area) {
        shade_found_targets(scene, light, shaft, found, count, points);
        return;
    }
#endif
    for (uint first = 0; first < count; first += VW) {
        FV3 v[3];
        load_casters(scene, found + first, v);
        MASK sure;
        ShadowTriangles t = set_up_shadow(v, shared_light(light), scene.view.extent, &sure);
        MASK may = sure & may_shade(shaft, &t) & lane_mask(lane_numbers < (UV)(count - first));
        if (!lane_any(may)) continue;
        FoundTriangles triangles;
        triangles.wanted = lane_ballot(may);
        triangles.children = found + first;
        store_forms(&t, &triangles.forms);
        shade_rows(points, &triangles, scene, light);
    }
}

// Prefetches a node.
static inline void prefetch_node(global const ShadowNode* node) {
    for (uint i = 0; i < sizeof(ShadowNode) / 64; ++i) {
        prefetch_to_read((global const uchar*)node + i * 64);
    }
}

// Counts rays of the walks since `before`, and those of them that are left lit.
static inline void count_rays(ShadowPoints* points, ulong tests_before, uint rays, uint seen) {
#if COUNT_SHADOWS
    points->counts.rays += rays;
    points->counts.seen += seen;
    if (points->counts.points != tests_before) points->counts.met_rays += rays;
#endif
}

static inline ulong counted_tests(const ShadowPoints* points) {
#if COUNT_SHADOWS
    return points->counts.points;
#else
    return 0;
#endif
}

// Clears the lit flag of each point that a triangle hides from the light, in the rows first .. end
// - 1, which face_light() began. low, high: box of the lit points.
static inline void cast_shadows_of(ShadowScene scene, ShadowLight light, float3 low, float3 high,
                                   uint first, uint end, ShadowPoints* points) {
    ADD_COUNT(points, shafts, 1);
    Shaft shaft = make_shaft(light, low, high);
    uint stack[SHADOW_STACK];
    uint found[SHADOW_BATCH + SHADOW_WIDTH];
    uint top = 1;
    uint count = 0;
    stack[0] = 0;
    find_lit_rows(points, first, end);
    while (top > 0u && points->row_count > 0u) {
        global const ShadowNode* node = scene.nodes + stack[--top];
        ADD_COUNT(points, nodes, 1);
        for (uint child = 0; child < SHADOW_WIDTH; child += VW) {
            uint bits = lane_ballot(meets_children(shaft, node, child));
            for (; bits != 0u; bits &= bits - 1u) {
                uint number = node->child[child + lowest_bit(bits)];
                if ((number & SHADOW_LEAF) != 0u) {
                    found[count++] = number;
                } else {
                    prefetch_node(scene.nodes + number);
                    stack[top++] = number;
                }
            }
        }
        if (count > SHADOW_BATCH - SHADOW_WIDTH || (top == 0u && count > 0u)) {
            shade_found(scene, light, shaft, found, count, points);
            count = 0;
        }
    }
}
#endif
