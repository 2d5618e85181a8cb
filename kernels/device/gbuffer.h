// SPDX-License-Identifier: Apache-2.0
// Decodes VW pixels of a G-buffer. GBUFFER and the first column of SURFACE_VALUES say what it
// holds.
#ifndef KILOLUX_DEVICE_GBUFFER_H
#define KILOLUX_DEVICE_GBUFFER_H
#include "kernels/device/lanes.h"
#include "kernels/device/pixels.h"
#include "kernels/device/prefetch.h"
#include "kernels/shared/evaluate.h"
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/pack.h"
#include "kernels/shared/view.h"

#ifndef GBUFFER
#define GBUFFER GBUFFER_PACKED
#endif

// The arguments by which a kernel reads a G-buffer.
typedef struct GBuffer {
    global const uchar* bytes;
    GBufferLayout layout;
    View view;
    global const float* srgb;  // [256] linear value of an sRGB code
} GBuffer;

static inline FV load_float(GBuffer g, uint plane_index, Pixels pixels) {
    global const float* plane = (global const float*)(g.bytes + g.layout.offset_bytes[plane_index]);
    return LOAD_PLANE(FV, plane, pixels);
}

static inline UV load_uint(GBuffer g, uint plane_index, Pixels pixels) {
    global const uint* plane = (global const uint*)(g.bytes + g.layout.offset_bytes[plane_index]);
    return LOAD_PLANE(UV, plane, pixels);
}

static inline void prefetch_plane(GBuffer g, uint plane_index, uint place) {
    prefetch_to_read(g.bytes + g.layout.offset_bytes[plane_index] + place * sizeof(uint));
}

// Prefetches pixels from `place` in their planes on: all planes of layouts with planes of four
// bytes; the depth of those for comparison.
static inline void prefetch_surface(GBuffer g, uint place) {
    prefetch_plane(g, PLANE_DEPTH, place);
#if GBUFFER == GBUFFER_PACKED || GBUFFER == GBUFFER_NORMAL_XY
    prefetch_plane(g, PLANE_NORMAL, place);
    prefetch_plane(g, PLANE_ALBEDO, place);
#if HAS_MATERIAL
    prefetch_plane(g, PLANE_MATERIAL, place);
#endif
#define PREFETCH_PACKED(has, plane, pack, unpack) \
    if (has != 0) prefetch_plane(g, plane, place);
    PACKED_PLANES(PREFETCH_PACKED)
#endif
}

// Depth buffer values; 0: background.
static inline FV load_depth01(GBuffer g, Pixels pixels) {
    return load_float(g, PLANE_DEPTH, pixels);
}

// Linear value of each lane's sRGB code.
static inline FV srgb_to_linear(global const float* table, UV code) {
#if VW == 1
    return table[code];
#else
    uint index[VW];
    lane_store(code, index);
    return lane_gather(FV, table, index);
#endif
}

static inline FV3 decode_srgb(global const float* table, UV rgba) {
    return fv3(srgb_to_linear(table, rgba & 255u), srgb_to_linear(table, (rgba >> 8) & 255u),
               srgb_to_linear(table, (rgba >> 16) & 255u));
}

static inline FV3 rotate_to_view(View view, FV3 v) {
    float4 x = view.view_from_world_x;
    float4 y = view.view_from_world_y;
    float4 z = view.view_from_world_z;
    return fv3(fma(fv(x.z), v.z, fma(fv(x.y), v.y, fv(x.x) * v.x)),
               fma(fv(y.z), v.z, fma(fv(y.y), v.y, fv(y.x) * v.x)),
               fma(fv(z.z), v.z, fma(fv(z.y), v.y, fv(z.x) * v.x)));
}

static inline FV3 load_float3(GBuffer g, uint first_plane, Pixels pixels) {
    return fv3(load_float(g, first_plane, pixels), load_float(g, first_plane + 1, pixels),
               load_float(g, first_plane + 2, pixels));
}

#define HALF_AT(i, plane, pixels) vload_half(PLACE(i, pixels), plane)

static inline FV load_half(GBuffer g, uint plane_index, Pixels pixels) {
    global const half* plane = (global const half*)(g.bytes + g.layout.offset_bytes[plane_index]);
#if VW > 1
#if ORDERED_PIXELS
    if (!pixels.in_row) return LANES(FV, HALF_AT, plane, pixels);
#endif
    return KX_CONCAT(vload_half, VW)(0, plane + pixels.first);
#else
    return HALF_AT(0, plane, pixels);
#endif
}

static inline global const float4* row_plane(GBuffer g, uint plane_index) {
    return (global const float4*)(g.bytes + g.layout.offset_bytes[plane_index]);
}
#define ROW_X(i, rows, pixels) (rows)[PLACE(i, pixels)].x
#define ROW_Y(i, rows, pixels) (rows)[PLACE(i, pixels)].y
#define ROW_Z(i, rows, pixels) (rows)[PLACE(i, pixels)].z
#define ROW_W(i, rows, pixels) (rows)[PLACE(i, pixels)].w

// Positions in view space of pixels with depth z [m].
static inline FV3 load_position(GBuffer g, Pixels pixels, FV z) {
#if GBUFFER == GBUFFER_FULL
    return load_float3(g, PLANE_POSITION_X, pixels);
#elif GBUFFER == GBUFFER_OCT_2X4
    global const float4* rows = row_plane(g, PLANE_ROW_0);
    return fv3(LANES(FV, ROW_X, rows, pixels), LANES(FV, ROW_Y, rows, pixels),
               LANES(FV, ROW_Z, rows, pixels));
#elif GBUFFER == GBUFFER_HALF
    // World positions in half floats, as three WebGPU ancestors store them.
    float4 camera = g.view.camera_position;
    FV3 world = fv3(load_half(g, PLANE_POSITION_X, pixels) - camera.x,
                    load_half(g, PLANE_POSITION_Y, pixels) - camera.y,
                    load_half(g, PLANE_POSITION_Z, pixels) - camera.z);
    return rotate_to_view(g.view, world);
#else
    return view_position(g.view, pixels.x, pixels.y, z);
#endif
}

static inline FV3 load_normal(GBuffer g, Pixels pixels) {
#if GBUFFER == GBUFFER_FULL
    return load_float3(g, PLANE_NORMAL_X, pixels);
#elif GBUFFER == GBUFFER_HALF
    FV3 world = fv3(load_half(g, PLANE_NORMAL_X, pixels), load_half(g, PLANE_NORMAL_Y, pixels),
                    load_half(g, PLANE_NORMAL_Z, pixels));
    FV3 n = rotate_to_view(g.view, world);
    return scale3(n, lane_rsqrt(max(dot3(n, n), fv(1e-20f))));
#elif GBUFFER == GBUFFER_OCT_2X4
    global const float4* rows = row_plane(g, PLANE_ROW_1);
    return octahedral_decode(LANES(FV, ROW_X, rows, pixels), LANES(FV, ROW_Y, rows, pixels));
#else
    UV packed = load_uint(g, PLANE_NORMAL, pixels);
    FV nx = snorm_of_unorm16(packed & 0xffffu);
    FV ny = snorm_of_unorm16(packed >> 16);
#if GBUFFER == GBUFFER_NORMAL_XY
    return fv3(nx, ny, lane_sqrt(max(fma(-nx, nx, fma(-ny, ny, fv(1.0f))), fv(0.0f))));
#else
    return octahedral_decode(nx, ny);
#endif
#endif
}

static inline Surface load_float_material(GBuffer g, Pixels pixels, Surface s) {
#define LOAD_VECTOR(has, member, decoded, plane, value) \
    if (has != 0) s.member = load_float3(g, plane, pixels);
#define LOAD_SCALAR(has, member, decoded, plane, value) \
    if (has != 0) s.member = load_float(g, plane, pixels);
    SURFACE_VALUES(LOAD_VECTOR, LOAD_SCALAR)
    return s;
}

#define CODE_AT(i, plane, pixels) ((uint)PLANE_AT(i, plane, pixels))

// The 8-bit planes that all layouts but `full` may have.
static inline Surface load_optional_planes(GBuffer g, Pixels pixels, Surface s) {
#if HAS_MATERIAL
    UV material = load_uint(g, PLANE_MATERIAL, pixels);
    s.emissive = scale3(decode_srgb(g.srgb, material), fv(g.layout.emissive_scale));
    s.metallic = unorm8(material >> 24);
#endif
#if HAS_OCCLUSION
    global const uchar* plane = g.bytes + g.layout.offset_bytes[PLANE_OCCLUSION];
    s.occlusion = unorm8(LANES(UV, CODE_AT, plane, pixels));
#endif
#define LOAD_PACKED(has, plane, pack, unpack) \
    if (has != 0) s = unpack(load_uint(g, plane, pixels), s);
    PACKED_PLANES(LOAD_PACKED)
    return s;
}

static inline Surface load_packed_material(GBuffer g, Pixels pixels, Surface s) {
    UV rgba = load_uint(g, PLANE_ALBEDO, pixels);
#if GBUFFER == GBUFFER_HALF
    s.albedo = unorm8_color(rgba);
#else
    s.albedo = decode_srgb(g.srgb, rgba);
#endif
    s.roughness = unorm8(rgba >> 24);
    return load_optional_planes(g, pixels, s);
}

static inline Surface load_row_material(GBuffer g, Pixels pixels, Surface s) {
    global const float4* rows = row_plane(g, PLANE_ROW_0);
    s.albedo = unorm8_color(lane_to_uint(LANES(FV, ROW_W, rows, pixels)));
    s = load_optional_planes(g, pixels, s);
    rows = row_plane(g, PLANE_ROW_1);
    s.roughness = LANES(FV, ROW_Z, rows, pixels);
#if HAS_MATERIAL
    s.metallic = LANES(FV, ROW_W, rows, pixels);
#endif
    return s;
}

// The surfaces of pixels at depths z [m].
static inline Surface load_surface(GBuffer g, Pixels pixels, FV z) {
    Surface s = default_surface();
    s.position = load_position(g, pixels, z);
    s.normal = load_normal(g, pixels);
#if HAS_CLEARCOAT && !HAS_COAT_NORMAL
    s.coat_normal = s.normal;
#endif
#if GBUFFER == GBUFFER_FULL
    return load_float_material(g, pixels, s);
#elif GBUFFER == GBUFFER_OCT_2X4
    return load_row_material(g, pixels, s);
#else
    return load_packed_material(g, pixels, s);
#endif
}
#endif
