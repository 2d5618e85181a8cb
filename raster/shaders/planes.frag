#version 450 core
// SPDX-License-Identifier: Apache-2.0
// A fragment's surface to the G-buffer. GBUFFER names the layout; ATTACHMENTS are the targets of
// its planes, and PLANE_SLOTS says where each plane goes: 4 * target + component. EMISSIVE_SCALE:
// see GBufferLayout.
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/tone_curve.h"
#include "raster/shaders/surface.glsl"

layout(std430, binding = SRGB_BLOCK) readonly buffer SrgbBuckets {
    float srgb_boundary[SRGB_BUCKETS];
    uint srgb_bucket_code[SRGB_BUCKETS];
};
struct SrgbBucket {
    float boundary;
    uint code;
};
#define SrgbTable uint
#define bucket_at(table, bucket) SrgbBucket(srgb_boundary[bucket], srgb_bucket_code[bucket])
#include "kernels/shared/srgb_code.h"

layout(location = 0) precise out uvec4 out_planes[ATTACHMENTS];

struct GBufferTarget {
    View view;
    Pixels pixels;
};

const uint kSlots[PLANE_COUNT] = PLANE_SLOTS;
uvec4 stored[ATTACHMENTS];

#define emissive_scale_of(to) EMISSIVE_SCALE
#define encode_srgb(to, v) srgb_code_by_table(0u, v)

void store_plane_uint(GBufferTarget to, uint plane, uint value) {
    stored[kSlots[plane] / 4u][kSlots[plane] % 4u] = value;
}

void store_plane_byte(GBufferTarget to, uint plane, uint value) {
    store_plane_uint(to, plane, value);
}

void store_plane_float(GBufferTarget to, uint plane, float value) {
    store_plane_uint(to, plane, floatBitsToUint(value));
}

void store_plane_half(GBufferTarget to, uint plane, float value) {
    store_plane_uint(to, plane, packHalf2x16(vec2(value, 0.0)));
}

void store_plane_row(GBufferTarget to, uint plane, float x, float y, float z, float w) {
    stored[kSlots[plane] / 4u] = floatBitsToUint(vec4(x, y, z, w));
}

#include "kernels/shared/store.h"

void main() {
    SurfaceScene scene = SurfaceScene(0u);
    Fragment f = drawn_fragment(scene);
    if (!is_covered(scene, f)) discard;
    GBufferTarget to = GBufferTarget(camera.view, fragment_pixels());
    store_surface(to, drawn_surface(scene, f), f.z);
    for (int i = 0; i < ATTACHMENTS; ++i) out_planes[i] = stored[i];
}
