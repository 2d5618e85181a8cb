// SPDX-License-Identifier: Apache-2.0
// Depth, normals and albedo as other renderers store them -> a packed G-buffer.
// One work-item repacks one pixel: built with one lane.
//
// DEPTH_FORMAT   0: float; 1, 2: 24 bits, the lower or the upper of a uint
// NORMAL_FORMAT  0: 4x8 UNORM; 1: 2x16 UNORM, octahedral; 2: 4 floats
// ALBEDO_FORMAT  0: 4x8 bits, sRGB; 1: 4 halves, linear. The 4th is the roughness
// FROM_IMAGES    1: images of any format with these values
#include "kernels/device/arguments.h"
#include "kernels/device/gbuffer.h"
#include "kernels/surfaces/store_gbuffer.h"

#if FROM_IMAGES
constant sampler_t kTexel =
    CLK_NORMALIZED_COORDS_FALSE | CLK_ADDRESS_CLAMP_TO_EDGE | CLK_FILTER_NEAREST;
#define SOURCE(element) read_only image2d_t
#else
#define SOURCE(element) global const element* restrict
#endif

// Larger is nearer, 0 is background; NaN becomes background.
static inline float stored_depth(float d, uint invert) {
    float stored = invert != 0u ? 1.0f - d : d;
    return stored > 0.0f ? stored : 0.0f;
}

#if DEPTH_FORMAT != 0 && !FROM_IMAGES
static inline float depth_of_code(uint word, uint invert) {
    const uint largest = 0xffffffu;
    uint code = DEPTH_FORMAT == 1 ? word & largest : word >> 8;
    return (float)(invert != 0u ? largest - code : code) / (float)largest;
}
#endif

static inline float4 unorm8x4(uint word) {
    return (float4)((float)(word & 255u), (float)((word >> 8) & 255u), (float)((word >> 16) & 255u),
                    (float)(word >> 24)) /
           255.0f;
}

// A direction of any length, in the source's space.
static inline FV3 direction_of(float4 v) {
#if NORMAL_FORMAT == 0
    return fv3(v.x * 2.0f - 1.0f, v.y * 2.0f - 1.0f, v.z * 2.0f - 1.0f);
#elif NORMAL_FORMAT == 1
    return octahedral_decode(v.x * 2.0f - 1.0f, v.y * 2.0f - 1.0f);
#else
    return fv3(v.x, v.y, v.z);
#endif
}

static inline uint normal_code(View view, float4 v, uint is_world) {
    FV3 n = direction_of(v);
    if (is_world != 0u) n = rotate_to_view(view, n);
    FV3 octahedral = octahedral_encode(n);
    return pack_normal(octahedral.x, octahedral.y);
}

// depth: bits of a float or 24; it, normal and albedo are [height][pitch], pitch in pixels. invert:
// 1: the depth plane holds 1 - d. world_normals: 0: they are in view space. roughness: of
// all surfaces, or ROUGHNESS_OF_ALBEDO.
#define SOURCE_ARGS                                                               \
    SOURCE(uint)                                                                  \
    depth, SOURCE(NORMAL) normal, SOURCE(ALBEDO) albedo, uint pitch, uint invert, \
        uint world_normals, float roughness

kernel void repack_gbuffer(SOURCE_ARGS, GBufferLayout layout, View view, BUCKET_ARGS,
                           global uchar* restrict gbuffer) {
    SrgbTable table = SRGB_TABLE_OF_ARGS;
    uint place = get_global_id(0);
    if (place >= view.stride * view.height) return;
    uint x = place % view.stride;
    uint y = place / view.stride;
    float depth01 = 0.0f;
    uint normal_word = 0u;
    uint albedo_word = 0u;
    if (x < view.width) {
#if FROM_IMAGES
        int2 at = (int2)((int)x, (int)y);
        depth01 = stored_depth(read_imagef(depth, kTexel, at).x, invert);
        normal_word = normal_code(view, read_imagef(normal, kTexel, at), world_normals);
        float4 color = read_imagef(albedo, kTexel, at);
#else
        uint at = y * pitch + x;
#if DEPTH_FORMAT == 0
        depth01 = stored_depth(as_float(depth[at]), invert);
#else
        depth01 = depth_of_code(depth[at], invert);
#endif
#if NORMAL_FORMAT == 0
        float4 n = unorm8x4(normal[at]);
#elif NORMAL_FORMAT == 1
        uint word = normal[at];
        float4 n = (float4)((float)(word & 0xffffu), (float)(word >> 16), 0.0f, 0.0f) / 65535.0f;
#else
        float4 n = normal[at];
#endif
        normal_word = normal_code(view, n, world_normals);
#if ALBEDO_FORMAT == 0
        float4 color = unorm8x4(albedo[at]);
#else
        float4 color = vload_half4(at, albedo);
#endif
#endif
        float rough = roughness == ROUGHNESS_OF_ALBEDO ? color.w : roughness;
#if ALBEDO_FORMAT == 0
        albedo_word = pack_linear(fv3(color.x, color.y, color.z), unorm_code(rough, 255.0f));
#else
        albedo_word = pack_color(srgb_code(table, color.x), srgb_code(table, color.y),
                                 srgb_code(table, color.z), unorm_code(rough, 255.0f));
#endif
    }
    bool shown = depth01 > BACKGROUND_DEPTH;
    ((global float*)(gbuffer + layout.offset_bytes[PLANE_DEPTH]))[place] = depth01;
    ((global uint*)(gbuffer + layout.offset_bytes[PLANE_NORMAL]))[place] = shown ? normal_word : 0u;
    ((global uint*)(gbuffer + layout.offset_bytes[PLANE_ALBEDO]))[place] = shown ? albedo_word : 0u;
}
