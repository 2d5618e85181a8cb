// SPDX-License-Identifier: Apache-2.0
// Visibility of one light at up to SHADOW_POINTS points: one walk through the hierarchy for all of
// them; the triangles that their shaft meets are tested on VW points at a time. By one work-item.
#ifndef KILOLUX_DEVICE_SHADOW_CAST_H
#define KILOLUX_DEVICE_SHADOW_CAST_H
#include "kernels/device/masked_caster.h"
#include "kernels/device/shadow_shaft.h"

// Triangles that wait for their test: whole vectors, and room for a node's children.
#define SHADOW_BATCH 64

// What casts shadows.
typedef struct ShadowScene {
    global const ShadowNode* nodes;  // 0: the root
    global const float* casters;     // [][3][3]
    MaskedScene masked;
    ShadowView view;
} ShadowScene;

// Points in rows of VW.
typedef struct ShadowPoints {
    float x[SHADOW_POINTS], y[SHADOW_POINTS], z[SHADOW_POINTS];  // [m]
    float nx[SHADOW_POINTS], ny[SHADOW_POINTS], nz[SHADOW_POINTS];
    // What edges' forms take, see ShadowForm.
    float ex[SHADOW_POINTS], ey[SHADOW_POINTS], ez[SHADOW_POINTS];
    int lit[SHADOW_POINTS];          // -1, or 0
    uchar rows[SHADOW_POINTS / VW];  // those with lit points
    uint row_count;
} ShadowPoints;

static inline void load_origins(ShadowPoints* to, uint row, global const float* origins, uint plane,
                                Pixels pixels) {
    uint at = row * VW;
    lane_store(LOAD_PLANE(FV, origins + ORIGIN_X * plane, pixels), to->x + at);
    lane_store(LOAD_PLANE(FV, origins + ORIGIN_Y * plane, pixels), to->y + at);
    lane_store(LOAD_PLANE(FV, origins + ORIGIN_Z * plane, pixels), to->z + at);
    FV3 n = unpacked_normal(LOAD_PLANE(FV, origins + ORIGIN_NORMAL * plane, pixels));
    lane_store(n.x, to->nx + at);
    lane_store(n.y, to->ny + at);
    lane_store(n.z, to->nz + at);
}

// A box that grows.
typedef struct LaneBox {
    FV3 low, high;
} LaneBox;

static inline LaneBox grown_box(LaneBox box, MASK mask, FV3 p) {
    box.low =
        select3(mask, fv3(min(box.low.x, p.x), min(box.low.y, p.y), min(box.low.z, p.z)), box.low);
    box.high = select3(mask, fv3(max(box.high.x, p.x), max(box.high.y, p.y), max(box.high.z, p.z)),
                       box.high);
    return box;
}

// Begins a light: which points of row `row` it could reach. The eye must see the side of the
// triangle that the light is on; beyond the range, and a little more, there is no light to block.
static inline MASK face_light(ShadowPoints* points, uint row, ShadowLight light, MASK wanted) {
    uint at = row * VW;
    FV3 p = fv3(lane_load(points->x + at), lane_load(points->y + at), lane_load(points->z + at));
    FV3 n = fv3(lane_load(points->nx + at), lane_load(points->ny + at), lane_load(points->nz + at));
    FV3 e = p;
    MASK lit = wanted;
    if (light.is_direction) {
        lit &= lane_mask(dot3(n, splat3(light.at)) > fv(0.0f));
    } else {
        FV3 d = sub3(p, splat3(light.at));
        lit &= lane_mask(dot3(n, d) < fv(0.0f)) &
               lane_mask(dot3(d, d) * light.inv_range2 < fv(1.001f));
        e = scale3(d, fv(1.0f) / max(size3(d), fv(1e-30f)));
    }
    lane_store(e.x, points->ex + at);
    lane_store(e.y, points->ey + at);
    lane_store(e.z, points->ez + at);
    lane_store(lit, points->lit + at);
    return lit;
}

static inline FV3 load_edge_points(const ShadowPoints* points, uint row) {
    uint at = row * VW;
    return fv3(lane_load(points->ex + at), lane_load(points->ey + at), lane_load(points->ez + at));
}
static inline FV3 load_points(const ShadowPoints* points, uint row) {
    uint at = row * VW;
    return fv3(lane_load(points->x + at), lane_load(points->y + at), lane_load(points->z + at));
}

// One triangle's forms in all lanes: g.x, g.y, g.z, c of the three edges and the plane, and the
// edges' units.
#define FORM_FLOATS 19
typedef struct FormRows {
    float of[FORM_FLOATS][VW];
} FormRows;

static inline void store_forms(const ShadowTriangles* t, FormRows* to) {
    for (uint i = 0; i < 3; ++i) {
        lane_store(t->edge[i].g.x, to->of[4 * i]);
        lane_store(t->edge[i].g.y, to->of[4 * i + 1]);
        lane_store(t->edge[i].g.z, to->of[4 * i + 2]);
        lane_store(t->edge[i].c, to->of[4 * i + 3]);
        lane_store(t->unit[i], to->of[16 + i]);
    }
    lane_store(t->plane.g.x, to->of[12]);
    lane_store(t->plane.g.y, to->of[13]);
    lane_store(t->plane.g.z, to->of[14]);
    lane_store(t->plane.c, to->of[15]);
}

static inline FV form_at(const float* f, FV3 x) {
    return fma(fv(f[0]), x.x, fma(fv(f[1]), x.y, fma(fv(f[2]), x.z, fv(f[3]))));
}

// What the points of a row are of a triangle.
typedef struct RowForms {
    FV u[3];
    MASK shaded;
} RowForms;

static inline RowForms test_row(const float* f, const ShadowPoints* points, uint row) {
    RowForms out;
    FV3 e = load_edge_points(points, row);
    out.u[0] = form_at(f, e);
    out.u[1] = form_at(f + 4, e);
    out.u[2] = form_at(f + 8, e);
    FV behind = form_at(f + 12, load_points(points, row));
    out.shaded = lane_mask(min(min(out.u[0], out.u[1]), min(out.u[2], behind)) >= fv(-1.0f));
    return out;
}

static inline void shade_rows(ShadowPoints* points, const FormRows* forms, uint lane,
                              ShadowScene scene, uint child) {
    float f[FORM_FLOATS];
    for (uint i = 0; i < FORM_FLOATS; ++i) f[i] = forms->of[i][lane];
    for (uint i = 0; i < points->row_count; ++i) {
        uint row = points->rows[i];
        RowForms r = test_row(f, points, row);
        MASK lit = lane_load(points->lit + row * VW);
#if HAS_MASKED_CASTERS
        if ((child & SHADOW_MASKED) != 0u && lane_any(r.shaded & lit)) {
            r.shaded &= is_opaque_at(scene.masked, child & SHADOW_NUMBER, r.u[0] * f[16],
                                     r.u[1] * f[17], r.u[2] * f[18]);
        }
#endif
        lane_store(lit & ~r.shaded, points->lit + row * VW);
    }
}

// Lists the rows that still have lit points.
static inline void find_lit_rows(ShadowPoints* points, uint first, uint end) {
    uint count = 0;
    for (uint row = first; row < end; ++row) {
        points->rows[count] = (uchar)row;
        count += lane_any(lane_load(points->lit + row * VW)) ? 1u : 0u;
    }
    points->row_count = count;
}

static inline uint caster_of(ShadowScene scene, uint child) {
    uint number = child & SHADOW_NUMBER;
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

// A bit for each lane of the mask.
static inline uint lane_ballot(MASK mask) {
    return lane_sum(KX_CONCAT(as_, UV)(mask) & ((UV)(1u) << lane_numbers));
}
static inline uint lowest_bit(uint bits) { return 31u - clz(bits & -bits); }

// Tests the triangles that the walk found. `found` has room for whole vectors.
static inline void shade_found(ShadowScene scene, ShadowLight light, Shaft shaft, uint* found,
                               uint count, ShadowPoints* points) {
    for (uint i = count; i < (count + VW - 1) / VW * VW; ++i) found[i] = found[count - 1];
    for (uint first = 0; first < count; first += VW) {
        FV3 v[3];
        load_casters(scene, found + first, v);
        MASK sure;
        ShadowTriangles t = set_up_shadow(v, light, scene.view.extent, &sure);
        MASK may = sure & may_shade(shaft, &t) & lane_mask(lane_numbers < (UV)(count - first));
        if (!lane_any(may)) continue;
        FormRows forms;
        store_forms(&t, &forms);
        for (uint bits = lane_ballot(may); bits != 0u; bits &= bits - 1u) {
            uint lane = lowest_bit(bits);
            shade_rows(points, &forms, lane, scene, found[first + lane]);
        }
    }
}

// Puts out the points' lit flags where something stands between them and the light, of the rows
// first .. end - 1, which face_light() began. low, high: box of the lit points.
static inline void cast_shadows_of(ShadowScene scene, ShadowLight light, float3 low, float3 high,
                                   uint first, uint end, ShadowPoints* points) {
    Shaft shaft = make_shaft(light, low, high);
    uint stack[SHADOW_STACK];
    uint found[SHADOW_BATCH + SHADOW_WIDTH];
    uint top = 1;
    uint count = 0;
    stack[0] = 0;
    find_lit_rows(points, first, end);
    while (top > 0u && points->row_count > 0u) {
        global const ShadowNode* node = scene.nodes + stack[--top];
        for (uint child = 0; child < SHADOW_WIDTH; child += VW) {
            uint bits = lane_ballot(meets_children(shaft, node, child));
            for (; bits != 0u; bits &= bits - 1u) {
                uint number = node->child[child + lowest_bit(bits)];
                if ((number & SHADOW_LEAF) != 0u) {
                    found[count++] = number;
                } else {
                    stack[top++] = number;
                }
            }
        }
        if (count > SHADOW_BATCH - SHADOW_WIDTH || (top == 0u && count > 0u)) {
            shade_found(scene, light, shaft, found, count, points);
            find_lit_rows(points, first, end);
            count = 0;
        }
    }
}
#endif
