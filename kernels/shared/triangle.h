// SPDX-License-Identifier: Apache-2.0
// A triangle's attributes at VW pixels, for OpenCL C and GLSL: the triangle is set up in scalars
// and interpolated in lanes.
//
// Homogeneous edges in view space (Olano and Greer 1997): with the ray d of a pixel and e_i = v_j x
// v_k, u_i = e_i . d is affine in the pixel, the barycentric weights are u_i / sum(u), and their
// derivatives are exact. Nothing is clipped and nothing divided by a vertex's depth, so a triangle
// that crosses the camera's plane is no special case. e_i is computed from sum and difference of
// its vertices: so it is small where the triangle is, and exactly minus that of the neighbour. For
// parallel rays every vertex is moved to depth 1, and depths are interpolated.
//
// With vertices rounded at 2^-24 of their distance r, weights err as a shift of the triangle by a
// few 2^-24 r does: less than 1e-3 of a pixel up to 8192 pixels a side.
//
// Each language defines before (kernels/device/triangle.h, raster/shaders/surface.glsl):
//   SurfaceScene, MESH(scene, i)           the scene, and a mesh's row
//   InstanceRef, INSTANCE(instance)        a drawn instance, and its row
//   vertex_index(scene, i)                 of the triangles' vertex numbers
//   VertexRef, vertex_row(scene, mesh, i)  a vertex
//   vertex_float(vertex, place), and of 2, 3 and 4 floats
//   Pixels                                 x, y: centres [pixel]
//
// Compile-time switches: HAS_TEXCOORD0, HAS_TEXCOORD1, HAS_VERTEX_COLOR, HAS_TANGENT,
// HAS_TRANSMISSION.
#ifndef KILOLUX_SHARED_TRIANGLE_H
#define KILOLUX_SHARED_TRIANGLE_H
#include "kernels/shared/surface_scene.h"
#include "kernels/shared/texture.h"
#include "kernels/shared/view.h"

// The vertex attributes at VW pixels, each of its own triangle.
SHARED_PLAIN_STRUCT(Fragment) {
    FV z;        // [m]
    FV3 normal;  // interpolated between unit vectors
#if HAS_TRANSMISSION
    FV scale;  // of lengths, from object space to metres
#endif
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
    FV4 color;
#endif
};

// Weights of vertices 1 and 2, and their change to the neighbouring pixels.
SHARED_PLAIN_STRUCT(Weights) {
    FV b1, b2;
    FV b1_dx, b2_dx, b1_dy, b2_dy;
};

// The vertices of a triangle while it is set up.
SHARED_PLAIN_STRUCT(Triangle) {
    InstanceRef instance;
    MeshRow mesh;
    VertexRef vertex[3];
};

// Triangle `number` of the mesh of an instance.
SHARED_FN Triangle mesh_triangle(SurfaceScene scene, InstanceRef instance, uint number) {
    Triangle t;
    t.instance = instance;
    t.mesh = MESH(scene, INSTANCE(instance).mesh);
    uint first = t.mesh.first_index + 3u * number;
    for (uint i = 0u; i < 3u; ++i) {
        t.vertex[i] = vertex_row(scene, t.mesh, vertex_index(scene, first + i));
    }
    return t;
}

SHARED_FN float row_times(float4 row, float3 v) {
    return fma(row.z, v.z, fma(row.y, v.y, row.x * v.x));
}

SHARED_FN float3 rows_times(float4 x, float4 y, float4 z, float3 v) {
    return make_float3(row_times(x, v), row_times(y, v), row_times(z, v));
}

// Turns a normal or another direction as the instance does.
SHARED_FN float3 turned_normal(InstanceRef instance, float3 v) {
    return rows_times(INSTANCE(instance).normal_from_object[0],
                      INSTANCE(instance).normal_from_object[1],
                      INSTANCE(instance).normal_from_object[2], v);
}

// The root mean square of the instance's scales along three perpendicular directions.
SHARED_FN float length_scale(InstanceRef instance) {
    float sum = 0.0f;
    for (uint i = 0u; i < 3u; ++i) {
        float4 row = INSTANCE(instance).view_from_object[i];
        sum += row_times(row, make_float3(row.x, row.y, row.z));
    }
    return sqrt(sum / 3.0f);
}

SHARED_FN float3 turned_vector(InstanceRef instance, float3 v) {
    return rows_times(INSTANCE(instance).view_from_object[0],
                      INSTANCE(instance).view_from_object[1],
                      INSTANCE(instance).view_from_object[2], v);
}

// A vertex in view space [m].
SHARED_FN float3 view_vertex(InstanceRef instance, float3 p) {
    float3 from_eye = (p - INSTANCE(instance).eye_high.xyz) - INSTANCE(instance).eye_low.xyz;
    float3 turned = turned_vector(instance, from_eye);
    return make_float3(turned.x + INSTANCE(instance).view_from_object[0].w,
                       turned.y + INSTANCE(instance).view_from_object[1].w,
                       turned.z + INSTANCE(instance).view_from_object[2].w);
}

// The unit vector along v, also where squares would overflow or underflow; 0 for 0.
SHARED_FN float3 unit_or_zero(float3 v) {
    float largest = max(max(fabs(v.x), fabs(v.y)), fabs(v.z));
    if (!(largest > 0.0f)) return make_float3(0.0f, 0.0f, 0.0f);
    float3 scaled = v / largest;
    float square = fma(scaled.z, scaled.z, fma(scaled.y, scaled.y, scaled.x * scaled.x));
    return scaled / sqrt(square);
}

SHARED_FN float3 cross_fma(float3 a, float3 b) {
    return make_float3(fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)),
                       fma(a.x, b.y, -(a.y * b.x)));
}

// Twice a x b.
SHARED_FN float3 edge_of(float3 a, float3 b) { return cross_fma(a + b, b - a); }

SHARED_FN FV along_ray(float3 e, FV rx, FV ry) {
    return fma(fv(e.x), rx, fma(fv(e.y), ry, fv(-e.z)));
}

// A triangle's homogeneous edges: e_i is opposite to vertex i; and their sum.
SHARED_PLAIN_STRUCT(TriangleEdges) { float3 e0, e1, e2, sum; };

// v0, v1, v2: vertices in view space.
SHARED_FN TriangleEdges triangle_edges(View view, float3 v0, float3 v1, float3 v2) {
    float3 h0 = v0;
    float3 h1 = v1;
    float3 h2 = v2;
    if (view.orthographic != 0u) h0.z = h1.z = h2.z = -1.0f;
    TriangleEdges t;
    t.e0 = edge_of(h1, h2);
    t.e1 = edge_of(h2, h0);
    t.e2 = edge_of(h0, h1);
    t.sum = 2.0f * cross_fma(h1 - h0, h2 - h0);
    return t;
}

// Where the triangle winds counter-clockwise.
SHARED_FN MASK winds_forward(View view, Pixels pixels, TriangleEdges t) {
    FV rx = fma(pixels.x, fv(view.ray.x), fv(view.ray.y));
    FV ry = fma(pixels.y, fv(view.ray.z), fv(view.ray.w));
    return lane_mask(along_ray(t.sum, rx, ry) < fv(0.0f));
}

SHARED_FN Weights weights_of(View view, Pixels pixels, TriangleEdges t) {
    FV rx = fma(pixels.x, fv(view.ray.x), fv(view.ray.y));
    FV ry = fma(pixels.y, fv(view.ray.z), fv(view.ray.w));
    FV sign_of_sum = lane_select(winds_forward(view, pixels, t), fv(-1.0f), fv(1.0f));
    // A pixel's centre may lie outside by as much as OpenGL snaps vertices: the nearest point
    // counts.
    FV u0 = max(along_ray(t.e0, rx, ry) * sign_of_sum, fv(0.0f));
    FV u1 = max(along_ray(t.e1, rx, ry) * sign_of_sum, fv(0.0f));
    FV u2 = max(along_ray(t.e2, rx, ry) * sign_of_sum, fv(0.0f));
    FV total = u0 + u1 + u2;
    FV inv = lane_select(lane_mask(total > fv(0.0f)), lane_reciprocal(total), fv(0.0f));
    Weights w;
    w.b1 = u1 * inv;
    w.b2 = u2 * inv;
    FV step_x = inv * sign_of_sum * view.ray.x;
    FV step_y = inv * sign_of_sum * view.ray.z;
    w.b1_dx = fma(-w.b1, fv(t.sum.x), fv(t.e1.x)) * step_x;
    w.b2_dx = fma(-w.b2, fv(t.sum.x), fv(t.e2.x)) * step_x;
    w.b1_dy = fma(-w.b1, fv(t.sum.y), fv(t.e1.y)) * step_y;
    w.b2_dy = fma(-w.b2, fv(t.sum.y), fv(t.e2.y)) * step_y;
    return w;
}

// a0 + b1 (a1 - a0) + b2 (a2 - a0).
SHARED_FN FV interpolate(Weights w, float a0, float a1, float a2) {
    return fma(w.b2, fv(a2 - a0), fma(w.b1, fv(a1 - a0), fv(a0)));
}

SHARED_FN FV3 interpolate3(Weights w, float3 a0, float3 a1, float3 a2) {
    return fv3(interpolate(w, a0.x, a1.x, a2.x), interpolate(w, a0.y, a1.y, a2.y),
               interpolate(w, a0.z, a1.z, a2.z));
}

#if HAS_TEXCOORD0 || HAS_TEXCOORD1
// Texture coordinates of vertex 0, and how those of the others differ.
SHARED_PLAIN_STRUCT(Texcoords) { float2 a0, d1, d2; };

// An absent set is (0, 0).
SHARED_FN Texcoords fetch_texcoords(Triangle t, uint place) {
    Texcoords c;
    c.a0 = c.d1 = c.d2 = make_float2(0.0f, 0.0f);
    if (place != SURFACE_ABSENT) {
        c.a0 = vertex_float2(t.vertex[0], place);
        c.d1 = vertex_float2(t.vertex[1], place) - c.a0;
        c.d2 = vertex_float2(t.vertex[2], place) - c.a0;
    }
    return c;
}

SHARED_FN Footprint interpolate_texcoord(Weights w, Texcoords t) {
    Footprint at;
    at.u = fma(w.b2, fv(t.d2.x), fma(w.b1, fv(t.d1.x), fv(t.a0.x)));
    at.v = fma(w.b2, fv(t.d2.y), fma(w.b1, fv(t.d1.y), fv(t.a0.y)));
    at.u_dx = fma(w.b2_dx, fv(t.d2.x), w.b1_dx * t.d1.x);
    at.v_dx = fma(w.b2_dx, fv(t.d2.y), w.b1_dx * t.d1.y);
    at.u_dy = fma(w.b2_dy, fv(t.d2.x), w.b1_dy * t.d1.x);
    at.v_dy = fma(w.b2_dy, fv(t.d2.y), w.b1_dy * t.d1.y);
    return at;
}

SHARED_FN Footprint take_texcoord(MASK mask, Footprint a, Footprint b) {
    Footprint at;
    at.u = lane_select(mask, a.u, b.u);
    at.v = lane_select(mask, a.v, b.v);
    at.u_dx = lane_select(mask, a.u_dx, b.u_dx);
    at.v_dx = lane_select(mask, a.v_dx, b.v_dx);
    at.u_dy = lane_select(mask, a.u_dy, b.u_dy);
    at.v_dy = lane_select(mask, a.v_dy, b.v_dy);
    return at;
}
#endif

SHARED_FN FV3 interpolate_normal(Weights w, Triangle t) {
    if (t.mesh.normal == SURFACE_ABSENT) return fv3(fv(0.0f), fv(0.0f), fv(0.0f));
    float3 n[3];
    for (uint i = 0u; i < 3u; ++i) {
        n[i] = turned_normal(t.instance, vertex_float3(t.vertex[i], t.mesh.normal));
    }
    if (INSTANCE(t.instance).is_similarity == 0u) {
        for (uint i = 0u; i < 3u; ++i) n[i] = unit_or_zero(n[i]);
    }
    return interpolate3(w, n[0], n[1], n[2]);
}

#if HAS_TANGENT
// Requires mesh.tangent.
SHARED_FN FV3 interpolate_tangent(Weights w, Triangle t) {
    bool similar = INSTANCE(t.instance).is_similarity != 0u;
    float3 tangent[3];
    for (uint i = 0u; i < 3u; ++i) {
        float3 object = vertex_float3(t.vertex[i], t.mesh.tangent);
        if (similar) {
            tangent[i] = turned_normal(t.instance, object);
        } else {
            tangent[i] = unit_or_zero(turned_vector(t.instance, object));
        }
    }
    return interpolate3(w, tangent[0], tangent[1], tangent[2]);
}

// A mirror turns a right-handed basis into a left-handed one.
SHARED_FN FV interpolate_handedness(Weights w, Triangle t) {
    uint place = t.mesh.tangent + 3u;
    return interpolate(w, vertex_float(t.vertex[0], place), vertex_float(t.vertex[1], place),
                       vertex_float(t.vertex[2], place)) *
           HANDEDNESS(INSTANCE(t.instance));
}
#endif

#if HAS_VERTEX_COLOR
SHARED_FN FV4 interpolate_color(Weights w, Triangle t) {
    float4 c[3];
    for (uint i = 0u; i < 3u; ++i) {
        c[i] = make_float4(1.0f, 1.0f, 1.0f, 1.0f);
        if (t.mesh.color != SURFACE_ABSENT) {
            c[i] = vertex_float4(t.vertex[i], t.mesh.color);
        }
    }
    FV4 color;
    color.x = interpolate(w, c[0].x, c[1].x, c[2].x);
    color.y = interpolate(w, c[0].y, c[1].y, c[2].y);
    color.z = interpolate(w, c[0].z, c[1].z, c[2].z);
    color.w = interpolate(w, c[0].w, c[1].w, c[2].w);
    return color;
}
#endif

// Sets the attributes of a triangle at the pixels of `mask`.
SHARED_FN void interpolate_triangle(View view, Pixels pixels, Triangle t, MASK mask,
                                    INOUT(Fragment) f) {
    float3 v[3];
    for (uint i = 0u; i < 3u; ++i) {
        v[i] = view_vertex(t.instance, vertex_float3(t.vertex[i], 0u));
    }
    TriangleEdges edges = triangle_edges(view, v[0], v[1], v[2]);
    MASK front = winds_forward(view, pixels, edges);
    Weights w = weights_of(view, pixels, edges);
    if (HANDEDNESS(INSTANCE(t.instance)) < 0.0f) front = lane_not(front);
    AT(f).front = lane_select_mask(mask, front, AT(f).front);
    AT(f).z = lane_select(mask, interpolate(w, -v[0].z, -v[1].z, -v[2].z), AT(f).z);
    AT(f).normal = select3(mask, interpolate_normal(w, t), AT(f).normal);
    AT(f).material = lane_select_uint(mask, lane_uint(t.mesh.material), AT(f).material);
#if HAS_TRANSMISSION
    AT(f).scale = lane_select(mask, fv(length_scale(t.instance)), AT(f).scale);
#endif
#if HAS_TANGENT
    FV3 tangent = fv3(fv(0.0f), fv(0.0f), fv(0.0f));
    FV handedness = fv(0.0f);
    if (t.mesh.tangent != SURFACE_ABSENT) {
        tangent = interpolate_tangent(w, t);
        handedness = interpolate_handedness(w, t);
    }
    AT(f).tangent = select3(mask, tangent, AT(f).tangent);
    AT(f).handedness = lane_select(mask, handedness, AT(f).handedness);
#endif
#if HAS_TEXCOORD0
    AT(f).texcoord0 = take_texcoord(
        mask, interpolate_texcoord(w, fetch_texcoords(t, t.mesh.texcoord0)), AT(f).texcoord0);
#endif
#if HAS_TEXCOORD1
    AT(f).texcoord1 = take_texcoord(
        mask, interpolate_texcoord(w, fetch_texcoords(t, t.mesh.texcoord1)), AT(f).texcoord1);
#endif
#if HAS_VERTEX_COLOR
    FV4 color = interpolate_color(w, t);
    AT(f).color.x = lane_select(mask, color.x, AT(f).color.x);
    AT(f).color.y = lane_select(mask, color.y, AT(f).color.y);
    AT(f).color.z = lane_select(mask, color.z, AT(f).color.z);
    AT(f).color.w = lane_select(mask, color.w, AT(f).color.w);
#endif
}

// The attributes of a pixel without a triangle.
SHARED_FN Fragment no_fragment() {
    Fragment f;
    f.front = lane_mask(fv(0.0f) < fv(1.0f));
    f.z = fv(1.0f);
    f.normal = fv3(fv(0.0f), fv(0.0f), fv(1.0f));
    f.material = lane_uint(0u);
#if HAS_TRANSMISSION
    f.scale = fv(1.0f);
#endif
#if HAS_TANGENT
    f.tangent = f.normal;
    f.handedness = fv(0.0f);
#endif
#if HAS_TEXCOORD0 || HAS_TEXCOORD1
    Footprint origin;
    origin.u = origin.v = origin.u_dx = origin.v_dx = origin.u_dy = origin.v_dy = fv(0.0f);
#endif
#if HAS_TEXCOORD0
    f.texcoord0 = origin;
#endif
#if HAS_TEXCOORD1
    f.texcoord1 = origin;
#endif
#if HAS_VERTEX_COLOR
    f.color.x = f.color.y = f.color.z = f.color.w = fv(1.0f);
#endif
    return f;
}
#endif
