// SPDX-License-Identifier: Apache-2.0
// Stores surfaces in the planes of a G-buffer, for OpenCL C and GLSL; device/gbuffer.h loads them.
//
// Each language defines before (kernels/surfaces/store_gbuffer.h, raster/shaders/planes.frag):
//   GBufferTarget                               where pixels go; its view and pixels
//   emissive_scale_of(to)                       GBufferLayout::emissive_scale
//   encode_srgb(to, v)                          sRGB code of linear light, correctly rounded
//   store_plane_float, _uint, _byte, _half(to, plane, v), store_plane_row(to, plane, x, y, z, w)
//
// GBUFFER and the first column of SURFACE_VALUES say which planes there are.
#ifndef KILOLUX_SHARED_STORE_H
#define KILOLUX_SHARED_STORE_H
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/pack.h"
#include "kernels/shared/surface.h"
#include "kernels/shared/view.h"

SHARED_FN UV pack_srgb(GBufferTarget to, FV3 c, UV a) {
    return pack_color(encode_srgb(to, c.x), encode_srgb(to, c.y), encode_srgb(to, c.z), a);
}

SHARED_FN void store_plane_float3(GBufferTarget to, uint first_plane, FV3 value) {
    store_plane_float(to, first_plane, value.x);
    store_plane_float(to, first_plane + 1u, value.y);
    store_plane_float(to, first_plane + 2u, value.z);
}

// The planes that all layouts but `full` may have.
SHARED_FN void store_optional_planes(GBufferTarget to, Surface s) {
#if HAS_MATERIAL
    FV3 emissive = scale3(s.emissive, fv(1.0f / emissive_scale_of(to)));
    store_plane_uint(to, PLANE_MATERIAL, pack_srgb(to, emissive, unorm_code(s.metallic, 255.0f)));
#endif
#if HAS_OCCLUSION
    store_plane_byte(to, PLANE_OCCLUSION, unorm_code(s.occlusion, 255.0f));
#endif
#define STORE_PACKED(has, plane, pack, unpack) \
    if (has != 0) store_plane_uint(to, plane, pack(s));
    PACKED_PLANES(STORE_PACKED)
}

#if GBUFFER == GBUFFER_FULL
SHARED_FN void store_layout(GBufferTarget to, Surface s) {
    store_plane_float3(to, PLANE_POSITION_X, s.position);
    store_plane_float3(to, PLANE_NORMAL_X, s.normal);
#define STORE_VECTOR(has, member, decoded, plane, value) \
    if (has != 0) store_plane_float3(to, plane, s.member);
#define STORE_SCALAR(has, member, decoded, plane, value) \
    if (has != 0) store_plane_float(to, plane, s.member);
    SURFACE_VALUES(STORE_VECTOR, STORE_SCALAR)
}
#elif GBUFFER == GBUFFER_HALF
// Stores a vector in world axes, from the world's origin on, as half floats, finite.
SHARED_FN void store_plane_half3(GBufferTarget to, uint first_plane, FV3 v, float4 offset) {
    float4 x = to.view.view_from_world_x;
    float4 y = to.view.view_from_world_y;
    float4 z = to.view.view_from_world_z;
    FV3 world = fv3(fma(fv(z.x), v.z, fma(fv(y.x), v.y, fma(fv(x.x), v.x, fv(offset.x)))),
                    fma(fv(z.y), v.z, fma(fv(y.y), v.y, fma(fv(x.y), v.x, fv(offset.y)))),
                    fma(fv(z.z), v.z, fma(fv(y.z), v.y, fma(fv(x.z), v.x, fv(offset.z)))));
    store_plane_half(to, first_plane, min(max(world.x, fv(-65504.0f)), fv(65504.0f)));
    store_plane_half(to, first_plane + 1u, min(max(world.y, fv(-65504.0f)), fv(65504.0f)));
    store_plane_half(to, first_plane + 2u, min(max(world.z, fv(-65504.0f)), fv(65504.0f)));
}

SHARED_FN void store_layout(GBufferTarget to, Surface s) {
    store_plane_half3(to, PLANE_POSITION_X, s.position, to.view.camera_position);
    store_plane_half3(to, PLANE_NORMAL_X, s.normal, make_float4(0.0f, 0.0f, 0.0f, 0.0f));
    store_plane_uint(to, PLANE_ALBEDO, pack_linear(s.albedo, unorm_code(s.roughness, 255.0f)));
    store_optional_planes(to, s);
}
#elif GBUFFER == GBUFFER_OCT_2X4
SHARED_FN void store_layout(GBufferTarget to, Surface s) {
    FV albedo = lane_to_float(pack_linear(s.albedo, lane_uint(0u)));
    FV3 octahedral = octahedral_encode(s.normal);
    store_plane_row(to, PLANE_ROW_0, s.position.x, s.position.y, s.position.z, albedo);
    store_plane_row(to, PLANE_ROW_1, octahedral.x, octahedral.y, s.roughness, s.metallic);
    store_optional_planes(to, s);
}
#else
SHARED_FN void store_layout(GBufferTarget to, Surface s) {
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
SHARED_FN FV depth01_of(View view, Pixels pixels, FV z) {
    FV q = view.orthographic != 0u ? z : fv(1.0f) / z;
    FV plane = fma(pixels.x, fv(view.depth.y), fma(pixels.y, fv(view.depth.z), fv(view.depth.w)));
    return max((q - plane) / view.depth.x, fv(1e-30f));
}

SHARED_FN void store_surface(GBufferTarget to, Surface s, FV z) {
    store_plane_float(to, PLANE_DEPTH, depth01_of(to.view, to.pixels, z));
    store_layout(to, s);
}
#endif
