// SPDX-License-Identifier: Apache-2.0
// Decodes VW neighbouring pixels of a G-buffer. GBUFFER, HAS_MATERIAL, HAS_OCCLUSION and
// HAS_SPECULAR say what it holds.
#ifndef KILOLUX_DEVICE_GBUFFER_H
#define KILOLUX_DEVICE_GBUFFER_H
#include "kernels/device/lanes.h"
#include "kernels/shared/evaluate.h"
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/view.h"

#ifndef GBUFFER
#define GBUFFER GBUFFER_PACKED
#endif
#ifndef HAS_MATERIAL
#define HAS_MATERIAL 0
#endif
#ifndef HAS_OCCLUSION
#define HAS_OCCLUSION 0
#endif

// What a kernel needs to read a G-buffer.
typedef struct GBuffer {
    global const uchar* bytes;
    GBufferLayout layout;
    View view;
    global const float* srgb;  // [256] linear value of an sRGB code
} GBuffer;

static inline global const float* float_plane(GBuffer g, uint plane, uint pixel) {
    return (global const float*)(g.bytes + g.layout.offset_bytes[plane]) + pixel;
}

static inline UV load_uint_plane(GBuffer g, uint plane, uint pixel) {
    return load_lanes((global const uint*)(g.bytes + g.layout.offset_bytes[plane]) + pixel);
}

// Depth buffer values of VW pixels from pixel (x, y) on; 0: background.
static inline FV load_depth01(GBuffer g, uint x, uint y) {
    return load_lanes(float_plane(g, PLANE_DEPTH, y * g.view.stride + x));
}

static inline FV pixel_centers_x(uint x) { return to_float_lanes(lane_numbers + x) + 0.5f; }

// In the picture, of row y of the planes.
static inline FV pixel_center_y(View view, uint y) {
    return fv((float)(y + view.first_row) + 0.5f);
}

// Linear value of each lane's sRGB code.
static inline FV srgb_to_linear(global const float* table, UV code) {
#if VW == 1
    return table[code];
#else
    uint index[VW];
    store_lanes(code, index);
#define TABLE_AT(i) table[index[i]]
    return LANES(FV, TABLE_AT);
#undef TABLE_AT
#endif
}

static inline FV3 decode_srgb(global const float* table, UV rgba) {
    return fv3(srgb_to_linear(table, rgba & 255u), srgb_to_linear(table, (rgba >> 8) & 255u),
               srgb_to_linear(table, (rgba >> 16) & 255u));
}

static inline FV unorm8(UV code) { return to_float_lanes(code) * (1.0f / 255.0f); }

// [-1, 1] of a 16-bit UNORM.
static inline FV snorm_of_unorm16(UV code) {
    return fma(to_float_lanes(code), fv(2.0f / 65535.0f), fv(-1.0f));
}

static inline FV3 rotate_to_view(View view, FV3 v) {
    float4 x = view.view_from_world_x;
    float4 y = view.view_from_world_y;
    float4 z = view.view_from_world_z;
    return fv3(fma(fv(x.z), v.z, fma(fv(x.y), v.y, fv(x.x) * v.x)),
               fma(fv(y.z), v.z, fma(fv(y.y), v.y, fv(y.x) * v.x)),
               fma(fv(z.z), v.z, fma(fv(z.y), v.y, fv(z.x) * v.x)));
}

static inline FV load_float(GBuffer g, uint plane, uint pixel) {
    return load_lanes(float_plane(g, plane, pixel));
}

static inline FV3 load_float3(GBuffer g, uint first_plane, uint pixel) {
    return fv3(load_float(g, first_plane, pixel), load_float(g, first_plane + 1, pixel),
               load_float(g, first_plane + 2, pixel));
}

static inline FV load_half(GBuffer g, uint plane, uint pixel) {
    global const half* p = (global const half*)(g.bytes + g.layout.offset_bytes[plane]) + pixel;
#if VW == 1
    return vload_half(0, p);
#else
    return KX_CONCAT(vload_half, VW)(0, p);
#endif
}

// The rows of VW pixels of a plane of float4.
static inline global const float4* load_rows(GBuffer g, uint plane, uint pixel) {
    return (global const float4*)(g.bytes + g.layout.offset_bytes[plane]) + pixel;
}
#define ROW_X(i) rows[i].x
#define ROW_Y(i) rows[i].y
#define ROW_Z(i) rows[i].z
#define ROW_W(i) rows[i].w

// Position in view space of VW pixels with depth z [m].
static inline FV3 load_position(GBuffer g, uint x, uint y, FV z) {
#if GBUFFER == GBUFFER_FULL
    return load_float3(g, PLANE_POSITION_X, y * g.view.stride + x);
#elif GBUFFER == GBUFFER_OCT_2X4
    global const float4* rows = load_rows(g, PLANE_ROW_0, y * g.view.stride + x);
    return fv3(LANES(FV, ROW_X), LANES(FV, ROW_Y), LANES(FV, ROW_Z));
#elif GBUFFER == GBUFFER_HALF
    // World positions in half floats, as three WebGPU ancestors store them.
    uint pixel = y * g.view.stride + x;
    float4 camera = g.view.camera_position;
    FV3 world = fv3(load_half(g, PLANE_POSITION_X, pixel) - camera.x,
                    load_half(g, PLANE_POSITION_Y, pixel) - camera.y,
                    load_half(g, PLANE_POSITION_Z, pixel) - camera.z);
    return rotate_to_view(g.view, world);
#else
    return view_position(g.view, pixel_centers_x(x), pixel_center_y(g.view, y), z);
#endif
}

static inline FV3 load_normal(GBuffer g, uint pixel) {
#if GBUFFER == GBUFFER_FULL
    return load_float3(g, PLANE_NORMAL_X, pixel);
#elif GBUFFER == GBUFFER_HALF
    FV3 world = fv3(load_half(g, PLANE_NORMAL_X, pixel), load_half(g, PLANE_NORMAL_Y, pixel),
                    load_half(g, PLANE_NORMAL_Z, pixel));
    FV3 n = rotate_to_view(g.view, world);
    return scale3(n, rsqrt(max(dot3(n, n), fv(1e-20f))));
#elif GBUFFER == GBUFFER_OCT_2X4
    global const float4* rows = load_rows(g, PLANE_ROW_1, pixel);
    return octahedral_decode(LANES(FV, ROW_X), LANES(FV, ROW_Y));
#else
    UV packed = load_uint_plane(g, PLANE_NORMAL, pixel);
    FV nx = snorm_of_unorm16(packed & 0xffffu);
    FV ny = snorm_of_unorm16(packed >> 16);
#if GBUFFER == GBUFFER_NORMAL_XY
    return fv3(nx, ny, sqrt(max(fma(-nx, nx, fma(-ny, ny, fv(1.0f))), fv(0.0f))));
#else
    return octahedral_decode(nx, ny);
#endif
#endif
}

static inline Surface load_float_material(GBuffer g, uint pixel, Surface s) {
    s.albedo = load_float3(g, PLANE_ALBEDO_R, pixel);
    s.roughness = load_float(g, PLANE_ROUGHNESS, pixel);
#if HAS_MATERIAL
    s.metallic = load_float(g, PLANE_METALLIC, pixel);
    s.emissive = load_float3(g, PLANE_EMISSIVE_R, pixel);
#endif
#if HAS_OCCLUSION
    s.occlusion = load_float(g, PLANE_OCCLUSION_F, pixel);
#endif
#if HAS_SPECULAR
    s.specular = load_float3(g, PLANE_SPECULAR_R, pixel);
    s.specular_f90 = load_float(g, PLANE_SPECULAR_F90, pixel);
#endif
    return s;
}

// Reflectance of a code, the square root in 255ths: 51 is DIELECTRIC_F0 exactly.
static inline FV reflectance_of(UV code) {
    FV root = to_float_lanes(code);
    return root * root * (1.0f / 65025.0f);
}

static inline FV3 unorm8_color(UV rgba) {
    return fv3(unorm8(rgba & 255u), unorm8((rgba >> 8) & 255u), unorm8((rgba >> 16) & 255u));
}

// The 8-bit planes that all layouts but `full` may have.
static inline Surface load_optional_planes(GBuffer g, uint pixel, Surface s) {
#if HAS_MATERIAL
    UV material = load_uint_plane(g, PLANE_MATERIAL, pixel);
    s.emissive = scale3(decode_srgb(g.srgb, material), fv(g.layout.emissive_scale));
    s.metallic = unorm8(material >> 24);
#endif
#if HAS_OCCLUSION
#if VW == 1
    uint code = (g.bytes + g.layout.offset_bytes[PLANE_OCCLUSION])[pixel];
#else
    UV code = KX_CONCAT(convert_,
                        UV)(load_lanes(g.bytes + g.layout.offset_bytes[PLANE_OCCLUSION] + pixel));
#endif
    s.occlusion = unorm8(code);
#endif
#if HAS_SPECULAR
    UV specular = load_uint_plane(g, PLANE_SPECULAR, pixel);
    s.specular = fv3(reflectance_of(specular & 255u), reflectance_of((specular >> 8) & 255u),
                     reflectance_of((specular >> 16) & 255u));
    s.specular_f90 = unorm8(specular >> 24);
#endif
    return s;
}

static inline Surface load_packed_material(GBuffer g, uint pixel, Surface s) {
    UV rgba = load_uint_plane(g, PLANE_ALBEDO, pixel);
#if GBUFFER == GBUFFER_HALF
    s.albedo = unorm8_color(rgba);
#else
    s.albedo = decode_srgb(g.srgb, rgba);
#endif
    s.roughness = unorm8(rgba >> 24);
    return load_optional_planes(g, pixel, s);
}

static inline Surface load_row_material(GBuffer g, uint pixel, Surface s) {
    global const float4* rows = load_rows(g, PLANE_ROW_0, pixel);
    s.albedo = unorm8_color(to_uint_lanes(LANES(FV, ROW_W)));
    s = load_optional_planes(g, pixel, s);
    rows = load_rows(g, PLANE_ROW_1, pixel);
    s.roughness = LANES(FV, ROW_Z);
#if HAS_MATERIAL
    s.metallic = LANES(FV, ROW_W);
#endif
    return s;
}

// The surfaces of VW pixels from (x, y) on at depths z [m].
static inline Surface load_surface(GBuffer g, uint x, uint y, FV z) {
    uint pixel = y * g.view.stride + x;
    Surface s;
    s.position = load_position(g, x, y, z);
    s.normal = load_normal(g, pixel);
    s.metallic = fv(0.0f);
    s.occlusion = fv(1.0f);
    s.emissive = zero3();
#if GBUFFER == GBUFFER_FULL
    return load_float_material(g, pixel, s);
#elif GBUFFER == GBUFFER_OCT_2X4
    return load_row_material(g, pixel, s);
#else
    return load_packed_material(g, pixel, s);
#endif
}
#endif
