// SPDX-License-Identifier: Apache-2.0
// Writes a block of pixels to a G-buffer, as load_surface() reads them.
#ifndef KILOLUX_DEVICE_STORE_GBUFFER_H
#define KILOLUX_DEVICE_STORE_GBUFFER_H
#include "kernels/device/lanes.h"
#include "kernels/device/srgb.h"
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/surface.h"
#include "kernels/shared/view.h"
#include "kernels/surfaces/block.h"

// Where pixels go.
typedef struct GBufferTarget {
    global uchar* bytes;
    GBufferLayout layout;
    View view;
    global const float* bucket_boundary;  // [SRGB_BUCKETS]
    global const uint* bucket_code;       // [SRGB_BUCKETS]
    Pixels pixels;
    MASK drawn;  // other pixels become 0 in every plane
} GBufferTarget;

static inline global uchar* plane_of(GBufferTarget to, uint plane) {
    return to.bytes + to.layout.offset_bytes[plane];
}

static inline void store_plane_float(GBufferTarget to, uint plane, FV value) {
    FV kept = lane_select(to.drawn, value, fv(0.0f));
    global float* at = (global float*)plane_of(to, plane) + to.pixels.first;
    STORE_BLOCK(kept, at, to.pixels, to.view.stride);
}

static inline void store_plane_uint(GBufferTarget to, uint plane, UV value) {
    UV kept = select((UV)(0u), value, to.drawn);
    global uint* at = (global uint*)plane_of(to, plane) + to.pixels.first;
    STORE_BLOCK(kept, at, to.pixels, to.view.stride);
}

static inline void store_plane_float3(GBufferTarget to, uint first_plane, FV3 value) {
    store_plane_float(to, first_plane, value.x);
    store_plane_float(to, first_plane + 1, value.y);
    store_plane_float(to, first_plane + 2, value.z);
}

// The code of v in [0, 1], rounded.
static inline UV unorm_code(FV v, float largest) {
    return lane_to_uint(fma(min(max(v, fv(0.0f)), fv(1.0f)), fv(largest), fv(0.5f)));
}

static inline UV pack_color(UV r, UV g, UV b, UV a) { return r | (g << 8) | (b << 16) | (a << 24); }

static inline UV pack_linear(FV3 c, UV a) {
    return pack_color(unorm_code(c.x, 255.0f), unorm_code(c.y, 255.0f), unorm_code(c.z, 255.0f), a);
}

static inline UV pack_srgb(GBufferTarget to, FV3 c, UV a) {
    return pack_color(srgb_code(to.bucket_boundary, to.bucket_code, c.x),
                      srgb_code(to.bucket_boundary, to.bucket_code, c.y),
                      srgb_code(to.bucket_boundary, to.bucket_code, c.z), a);
}

// Two coordinates in [-1, 1] as 16 bits each.
static inline UV pack_normal(FV x, FV y) {
    return unorm_code(fma(x, fv(0.5f), fv(0.5f)), 65535.0f) |
           (unorm_code(fma(y, fv(0.5f), fv(0.5f)), 65535.0f) << 16);
}

// The planes that all layouts but `full` may have.
static inline void store_optional_planes(GBufferTarget to, Surface s) {
#if HAS_MATERIAL
    FV3 emissive = scale3(s.emissive, fv(1.0f / to.layout.emissive_scale));
    store_plane_uint(to, PLANE_MATERIAL, pack_srgb(to, emissive, unorm_code(s.metallic, 255.0f)));
#endif
#if HAS_OCCLUSION
    UV code = select((UV)(0u), unorm_code(s.occlusion, 255.0f), to.drawn);
    global uchar* at = plane_of(to, PLANE_OCCLUSION) + to.pixels.first;
    STORE_BLOCK(lane_to_uchar(code), at, to.pixels, to.view.stride);
#endif
#if HAS_SPECULAR
    FV3 root = fv3(lane_sqrt(s.specular.x), lane_sqrt(s.specular.y), lane_sqrt(s.specular.z));
    store_plane_uint(to, PLANE_SPECULAR, pack_linear(root, unorm_code(s.specular_f90, 255.0f)));
#endif
}

#if GBUFFER == GBUFFER_FULL
static inline void store_layout(GBufferTarget to, Surface s) {
    store_plane_float3(to, PLANE_POSITION_X, s.position);
    store_plane_float3(to, PLANE_NORMAL_X, s.normal);
    store_plane_float3(to, PLANE_ALBEDO_R, s.albedo);
    store_plane_float(to, PLANE_ROUGHNESS, s.roughness);
#if HAS_MATERIAL
    store_plane_float(to, PLANE_METALLIC, s.metallic);
    store_plane_float3(to, PLANE_EMISSIVE_R, s.emissive);
#endif
#if HAS_OCCLUSION
    store_plane_float(to, PLANE_OCCLUSION_F, s.occlusion);
#endif
#if HAS_SPECULAR
    store_plane_float3(to, PLANE_SPECULAR_R, s.specular);
    store_plane_float(to, PLANE_SPECULAR_F90, s.specular_f90);
#endif
}
#elif GBUFFER == GBUFFER_HALF
// In world axes, about the world's origin: as half floats, finite.
static inline void store_plane_half(GBufferTarget to, uint plane, FV value) {
    FV finite = min(max(value, fv(-65504.0f)), fv(65504.0f));
    FV kept = lane_select(to.drawn, finite, fv(0.0f));
    global half* at = (global half*)plane_of(to, plane) + to.pixels.first;
    STORE_BLOCK_HALF(kept, at, to.pixels, to.view.stride);
}

static inline void store_plane_half3(GBufferTarget to, uint first_plane, FV3 v, float4 offset) {
    float4 x = to.view.view_from_world_x;
    float4 y = to.view.view_from_world_y;
    float4 z = to.view.view_from_world_z;
    store_plane_half(to, first_plane,
                     fma(fv(z.x), v.z, fma(fv(y.x), v.y, fma(fv(x.x), v.x, fv(offset.x)))));
    store_plane_half(to, first_plane + 1,
                     fma(fv(z.y), v.z, fma(fv(y.y), v.y, fma(fv(x.y), v.x, fv(offset.y)))));
    store_plane_half(to, first_plane + 2,
                     fma(fv(z.z), v.z, fma(fv(y.z), v.y, fma(fv(x.z), v.x, fv(offset.z)))));
}

static inline void store_layout(GBufferTarget to, Surface s) {
    store_plane_half3(to, PLANE_POSITION_X, s.position, to.view.camera_position);
    store_plane_half3(to, PLANE_NORMAL_X, s.normal, (float4)(0.0f));
    store_plane_uint(to, PLANE_ALBEDO, pack_linear(s.albedo, unorm_code(s.roughness, 255.0f)));
    store_optional_planes(to, s);
}
#elif GBUFFER == GBUFFER_OCT_2X4
static inline void store_rows(GBufferTarget to, uint plane, FV x, FV y, FV z, FV w) {
    float lanes[4][VW];
    lane_store(lane_select(to.drawn, x, fv(0.0f)), lanes[0]);
    lane_store(lane_select(to.drawn, y, fv(0.0f)), lanes[1]);
    lane_store(lane_select(to.drawn, z, fv(0.0f)), lanes[2]);
    lane_store(lane_select(to.drawn, w, fv(0.0f)), lanes[3]);
    global float4* rows = (global float4*)plane_of(to, plane) + to.pixels.first;
#if BLOCK_PIXELS
    for (uint i = 0; i < to.pixels.rows * BLOCK_COLUMNS; ++i) {
        rows[i / BLOCK_COLUMNS * to.view.stride + i % BLOCK_COLUMNS] =
            (float4)(lanes[0][i], lanes[1][i], lanes[2][i], lanes[3][i]);
    }
#else
    for (uint i = 0; i < VW; ++i) {
        rows[i] = (float4)(lanes[0][i], lanes[1][i], lanes[2][i], lanes[3][i]);
    }
#endif
}

static inline void store_layout(GBufferTarget to, Surface s) {
    FV albedo = lane_to_float(pack_linear(s.albedo, (UV)(0u)));
    FV3 octahedral = octahedral_encode(s.normal);
    store_rows(to, PLANE_ROW_0, s.position.x, s.position.y, s.position.z, albedo);
    store_rows(to, PLANE_ROW_1, octahedral.x, octahedral.y, s.roughness, s.metallic);
    store_optional_planes(to, s);
}
#else
static inline void store_layout(GBufferTarget to, Surface s) {
#if GBUFFER == GBUFFER_PACKED
    FV3 octahedral = octahedral_encode(s.normal);
    store_plane_uint(to, PLANE_NORMAL, pack_normal(octahedral.x, octahedral.y));
#else
    store_plane_uint(to, PLANE_NORMAL, pack_normal(s.normal.x, s.normal.y));
#endif
    store_plane_uint(to, PLANE_ALBEDO, pack_srgb(to, s.albedo, unorm_code(s.roughness, 255.0f)));
    store_optional_planes(to, s);
}
#endif

// The depth buffer's value at depth z [m]: view_depth() gives z back. Never 0, the background's.
static inline FV depth01_of(View view, Pixels pixels, FV z) {
    FV q = view.orthographic != 0u ? z : fv(1.0f) / z;
    FV plane = fma(pixels.x, fv(view.depth.y), fma(pixels.y, fv(view.depth.z), fv(view.depth.w)));
    return max((q - plane) / view.depth.x, fv(1e-30f));
}

static inline void store_surface(GBufferTarget to, Surface s, FV z) {
    store_plane_float(to, PLANE_DEPTH, depth01_of(to.view, to.pixels, z));
    store_layout(to, s);
}
#endif
