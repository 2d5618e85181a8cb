// SPDX-License-Identifier: Apache-2.0
// What triangle ids say is seen: triangles set up one by one, interpolated in lanes.
//
// Homogeneous edges in view space (Olano and Greer 1997): with the ray d of a pixel and
// e_i = v_j x v_k, u_i = e_i . d is affine in the pixel, the barycentric weights are u_i / sum(u),
// and their derivatives are exact. Nothing is clipped and nothing divided by a vertex's depth, so a
// triangle that crosses the camera's plane needs no care. e_i is made of sum and difference of its
// vertices: so it is small where the triangle is, and exactly minus that of the neighbour.
// Parallel rays: the same with every vertex moved to depth 1, and depths interpolated.
//
// With vertices rounded at 2^-24 of their distance r, weights err as a shift of the triangle by a
// few 2^-24 r does: less than 1e-3 of a pixel up to 8192 pixels a side.
//
// Compile-time switches: HAS_TEXCOORD0, HAS_TEXCOORD1, HAS_VERTEX_COLOR, HAS_TANGENT.
#ifndef KILOLUX_DEVICE_TRIANGLE_H
#define KILOLUX_DEVICE_TRIANGLE_H
#include "kernels/device/lanes.h"
#include "kernels/device/pixels.h"
#include "kernels/device/texture.h"
#include "kernels/shared/surface_scene.h"
#include "kernels/shared/view.h"

// The scene's buffers.
typedef struct SurfaceScene {
    global const InstanceRow* instances;  // ascending first_triangle, and an end
    global const uint* instance_blocks;   // the instance of every INSTANCE_BLOCK-th triangle
    global const MeshRow* meshes;
    global const float* vertices;
    global const uint* indices;
    global const SurfaceMaterial* materials;
    global const TextureRow* textures;
    global const ulong* texels;  // 16 bits a channel, linear, red lowest
} SurfaceScene;

// The vertex attributes at VW pixels, each of its own triangle.
typedef struct Fragment {
    FV z;        // [m]
    FV3 normal;  // interpolated between unit vectors
    MASK front;  // the side that the triangle winds counter-clockwise
    UV material;
#if HAS_TANGENT
    FV3 tangent;
    FV handedness;  // 0: no normal map
#endif
#if HAS_TEXCOORD0
    Footprint texcoord0;
#endif
#if HAS_TEXCOORD1
    Footprint texcoord1;
#endif
#if HAS_VERTEX_COLOR
    FV3 color;
#endif
} Fragment;

// Weights of vertices 1 and 2, and their change to the neighbouring pixels.
typedef struct Weights {
    FV b1, b2;
    FV b1_dx, b2_dx, b1_dy, b2_dy;
} Weights;

// A triangle's vertices on their way through.
typedef struct Triangle {
    global const InstanceRow* instance;
    MeshRow mesh;
    global const float* vertex[3];
} Triangle;

static inline uint instance_of(SurfaceScene scene, uint triangle) {
    global const uint* block = scene.instance_blocks + triangle / INSTANCE_BLOCK;
    uint first = block[0];
    uint end = block[1] + 1u;
    while (end - first > 1u) {
        uint middle = (first + end) / 2u;
        if (scene.instances[middle].first_triangle <= triangle) {
            first = middle;
        } else {
            end = middle;
        }
    }
    return first;
}

static inline Triangle fetch_triangle(SurfaceScene scene, uint id) {
    Triangle t;
    t.instance = scene.instances + instance_of(scene, id - 1u);
    t.mesh = scene.meshes[t.instance->mesh];
    uint first = t.mesh.first_index + 3u * (id - 1u - t.instance->first_triangle);
    for (uint i = 0; i < 3; ++i) {
        t.vertex[i] = scene.vertices + t.mesh.first_float +
                      (size_t)scene.indices[first + i] * t.mesh.vertex_floats;
    }
    return t;
}

static inline float row_times(float4 row, float3 v) {
    return fma(row.z, v.z, fma(row.y, v.y, row.x * v.x));
}

// A vertex in view space [m].
static inline float3 view_vertex(global const InstanceRow* o, float3 p) {
    float3 from_eye = (p - o->eye_high.xyz) - o->eye_low.xyz;
    return (float3)(row_times(o->view_from_object[0], from_eye) + o->view_from_object[0].w,
                    row_times(o->view_from_object[1], from_eye) + o->view_from_object[1].w,
                    row_times(o->view_from_object[2], from_eye) + o->view_from_object[2].w);
}

// The unit vector along v, also where squares would overflow or underflow; 0 for 0.
static inline float3 unit_or_zero(float3 v) {
    float largest = max(max(fabs(v.x), fabs(v.y)), fabs(v.z));
    if (!(largest > 0.0f)) return (float3)(0.0f);
    float3 scaled = v / largest;
    float square = fma(scaled.z, scaled.z, fma(scaled.y, scaled.y, scaled.x * scaled.x));
    return scaled / sqrt(square);
}

static inline float3 turned(global const float4* rows, float3 v) {
    return (float3)(row_times(rows[0], v), row_times(rows[1], v), row_times(rows[2], v));
}

static inline float3 cross_fma(float3 a, float3 b) {
    return (float3)(fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)),
                    fma(a.x, b.y, -(a.y * b.x)));
}

// Twice a x b.
static inline float3 edge_of(float3 a, float3 b) { return cross_fma(a + b, b - a); }

static inline FV along_ray(float3 e, FV rx, FV ry) {
    return fma(fv(e.x), rx, fma(fv(e.y), ry, fv(-e.z)));
}

// A triangle's homogeneous edges: e_i is opposite to vertex i; and their sum.
typedef struct TriangleEdges {
    float3 e0, e1, e2, sum;
} TriangleEdges;

// v: vertices in view space.
static inline TriangleEdges triangle_edges(View view, const float3* v) {
    float3 h0 = v[0];
    float3 h1 = v[1];
    float3 h2 = v[2];
    if (view.orthographic != 0u) h0.z = h1.z = h2.z = -1.0f;
    TriangleEdges out;
    out.e0 = edge_of(h1, h2);
    out.e1 = edge_of(h2, h0);
    out.e2 = edge_of(h0, h1);
    out.sum = 2.0f * cross_fma(h1 - h0, h2 - h0);
    return out;
}

// `front`: where the triangle shows its front.
static inline Weights weights_of(View view, Pixels pixels, TriangleEdges t, MASK* front) {
    FV rx = fma(pixels.x, fv(view.ray.x), fv(view.ray.y));
    FV ry = fma(pixels.y, fv(view.ray.z), fv(view.ray.w));
    *front = lane_mask(along_ray(t.sum, rx, ry) < fv(0.0f));
    FV sign = lane_select(*front, fv(-1.0f), fv(1.0f));
    // A pixel's centre may lie outside by what OpenGL snaps: the nearest point counts.
    FV u0 = max(along_ray(t.e0, rx, ry) * sign, fv(0.0f));
    FV u1 = max(along_ray(t.e1, rx, ry) * sign, fv(0.0f));
    FV u2 = max(along_ray(t.e2, rx, ry) * sign, fv(0.0f));
    FV total = u0 + u1 + u2;
    FV inv = lane_select(lane_mask(total > fv(0.0f)), lane_reciprocal(total), fv(0.0f));
    Weights w;
    w.b1 = u1 * inv;
    w.b2 = u2 * inv;
    FV step_x = inv * sign * view.ray.x;
    FV step_y = inv * sign * view.ray.z;
    w.b1_dx = fma(-w.b1, fv(t.sum.x), fv(t.e1.x)) * step_x;
    w.b2_dx = fma(-w.b2, fv(t.sum.x), fv(t.e2.x)) * step_x;
    w.b1_dy = fma(-w.b1, fv(t.sum.y), fv(t.e1.y)) * step_y;
    w.b2_dy = fma(-w.b2, fv(t.sum.y), fv(t.e2.y)) * step_y;
    return w;
}

// a0 + b1 (a1 - a0) + b2 (a2 - a0).
static inline FV interpolate(Weights w, float a0, float a1, float a2) {
    return fma(w.b2, fv(a2 - a0), fma(w.b1, fv(a1 - a0), fv(a0)));
}

static inline FV3 interpolate3(Weights w, const float3* a) {
    return fv3(interpolate(w, a[0].x, a[1].x, a[2].x), interpolate(w, a[0].y, a[1].y, a[2].y),
               interpolate(w, a[0].z, a[1].z, a[2].z));
}

#if HAS_TEXCOORD0 || HAS_TEXCOORD1
// Texture coordinates of vertex 0, and how those of the others differ.
typedef struct Texcoords {
    float2 a0, d1, d2;
} Texcoords;

// An absent set is (0, 0), as OpenGL reads a disabled attribute.
static inline Texcoords fetch_texcoords(Triangle t, uint place) {
    Texcoords out;
    out.a0 = out.d1 = out.d2 = (float2)(0.0f);
    if (place != SURFACE_ABSENT) {
        out.a0 = vload2(0, t.vertex[0] + place);
        out.d1 = vload2(0, t.vertex[1] + place) - out.a0;
        out.d2 = vload2(0, t.vertex[2] + place) - out.a0;
    }
    return out;
}

static inline Footprint interpolate_texcoord(Weights w, Texcoords t) {
    Footprint out;
    out.u = fma(w.b2, fv(t.d2.x), fma(w.b1, fv(t.d1.x), fv(t.a0.x)));
    out.v = fma(w.b2, fv(t.d2.y), fma(w.b1, fv(t.d1.y), fv(t.a0.y)));
    out.u_dx = fma(w.b2_dx, fv(t.d2.x), w.b1_dx * t.d1.x);
    out.v_dx = fma(w.b2_dx, fv(t.d2.y), w.b1_dx * t.d1.y);
    out.u_dy = fma(w.b2_dy, fv(t.d2.x), w.b1_dy * t.d1.x);
    out.v_dy = fma(w.b2_dy, fv(t.d2.y), w.b1_dy * t.d1.y);
    return out;
}

static inline Footprint take_texcoord(MASK mask, Footprint a, Footprint b) {
    Footprint out;
    out.u = lane_select(mask, a.u, b.u);
    out.v = lane_select(mask, a.v, b.v);
    out.u_dx = lane_select(mask, a.u_dx, b.u_dx);
    out.v_dx = lane_select(mask, a.v_dx, b.v_dx);
    out.u_dy = lane_select(mask, a.u_dy, b.u_dy);
    out.v_dy = lane_select(mask, a.v_dy, b.v_dy);
    return out;
}
#endif

static inline FV3 interpolate_normal(Weights w, Triangle t) {
    if (t.mesh.normal == SURFACE_ABSENT) return fv3(fv(0.0f), fv(0.0f), fv(0.0f));
    float3 n[3];
    for (uint i = 0; i < 3; ++i) {
        n[i] = turned(t.instance->normal_from_object, vload3(0, t.vertex[i] + t.mesh.normal));
    }
    if (t.instance->is_similarity == 0u) {
        for (uint i = 0; i < 3; ++i) n[i] = unit_or_zero(n[i]);
    }
    return interpolate3(w, n);
}

#if HAS_TANGENT
static inline FV3 interpolate_tangent(Weights w, Triangle t, FV* handedness) {
    *handedness = fv(0.0f);
    if (t.mesh.tangent == SURFACE_ABSENT) return fv3(fv(0.0f), fv(0.0f), fv(0.0f));
    bool similar = t.instance->is_similarity != 0u;
    float3 tangent[3];
    float sign[3];
    for (uint i = 0; i < 3; ++i) {
        float4 object = vload4(0, t.vertex[i] + t.mesh.tangent);
        tangent[i] = similar ? turned(t.instance->normal_from_object, object.xyz)
                             : unit_or_zero(turned(t.instance->view_from_object, object.xyz));
        sign[i] = object.w;
    }
    // A mirror turns a right-handed basis into a left-handed one.
    *handedness = interpolate(w, sign[0], sign[1], sign[2]) * t.instance->normal_from_object[0].w;
    return interpolate3(w, tangent);
}
#endif

// The attributes of triangle `id` at the pixels of `mask`.
static inline void interpolate_triangle(SurfaceScene scene, View view, Pixels pixels, uint id,
                                        MASK mask, Fragment* out) {
    Triangle t = fetch_triangle(scene, id);
    float3 v[3];
    for (uint i = 0; i < 3; ++i) v[i] = view_vertex(t.instance, vload3(0, t.vertex[i]));
    MASK front;
    Weights w = weights_of(view, pixels, triangle_edges(view, v), &front);
    bool mirrored = t.instance->normal_from_object[0].w < 0.0f;
    out->front = (mask & (mirrored ? ~front : front)) | (~mask & out->front);
    out->z = lane_select(mask, interpolate(w, -v[0].z, -v[1].z, -v[2].z), out->z);
    out->normal = select3(mask, interpolate_normal(w, t), out->normal);
    out->material = select(out->material, (UV)(t.mesh.material), mask);
#if HAS_TANGENT
    FV handedness;
    out->tangent = select3(mask, interpolate_tangent(w, t, &handedness), out->tangent);
    out->handedness = lane_select(mask, handedness, out->handedness);
#endif
#if HAS_TEXCOORD0
    out->texcoord0 = take_texcoord(
        mask, interpolate_texcoord(w, fetch_texcoords(t, t.mesh.texcoord0)), out->texcoord0);
#endif
#if HAS_TEXCOORD1
    out->texcoord1 = take_texcoord(
        mask, interpolate_texcoord(w, fetch_texcoords(t, t.mesh.texcoord1)), out->texcoord1);
#endif
#if HAS_VERTEX_COLOR
    float3 color[3];
    for (uint i = 0; i < 3; ++i) {
        color[i] =
            t.mesh.color == SURFACE_ABSENT ? (float3)(1.0f) : vload3(0, t.vertex[i] + t.mesh.color);
    }
    out->color = select3(mask, interpolate3(w, color), out->color);
#endif
}

// The number in the first lane of `mask`.
static inline uint first_of(UV numbers, MASK mask) {
#if VW == 1
    return numbers;
#else
    return lane_min_uint(select((UV)(SURFACE_ABSENT), numbers, mask));
#endif
}

// The attributes where `drawn`; undefined elsewhere.
static inline Fragment interpolate_fragment(SurfaceScene scene, View view, Pixels pixels, UV ids,
                                            MASK drawn) {
    Fragment out;
    out.front = drawn;
    out.z = fv(1.0f);
    out.normal = fv3(fv(0.0f), fv(0.0f), fv(1.0f));
    out.material = (UV)(0u);
#if HAS_TANGENT
    out.tangent = out.normal;
    out.handedness = fv(0.0f);
#endif
#if HAS_TEXCOORD0 || HAS_TEXCOORD1
    Footprint origin;
    origin.u = origin.v = origin.u_dx = origin.v_dx = origin.u_dy = origin.v_dy = fv(0.0f);
#endif
#if HAS_TEXCOORD0
    out.texcoord0 = origin;
#endif
#if HAS_TEXCOORD1
    out.texcoord1 = origin;
#endif
#if HAS_VERTEX_COLOR
    out.color = fv3(fv(1.0f), fv(1.0f), fv(1.0f));
#endif
    for (MASK left = drawn; lane_any(left);) {
        uint id = first_of(ids, left);
        MASK mask = lane_mask(ids == (UV)(id)) & drawn;
        interpolate_triangle(scene, view, pixels, id, mask, &out);
        left &= ~mask;
    }
    return out;
}
#endif
