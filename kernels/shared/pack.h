// SPDX-License-Identifier: Apache-2.0
// Codes of a surface's values, and the values of codes, for OpenCL C and GLSL.
#ifndef KILOLUX_SHARED_PACK_H
#define KILOLUX_SHARED_PACK_H
#include "kernels/shared/surface.h"

// The code of v in [0, 1], rounded.
SHARED_FN UV unorm_code(FV v, float largest) {
    return lane_to_uint(fma(min(max(v, fv(0.0f)), fv(1.0f)), fv(largest), fv(0.5f)));
}

SHARED_FN UV pack_color(UV r, UV g, UV b, UV a) { return r | (g << 8) | (b << 16) | (a << 24); }

SHARED_FN UV pack_linear(FV3 c, UV a) {
    return pack_color(unorm_code(c.x, 255.0f), unorm_code(c.y, 255.0f), unorm_code(c.z, 255.0f), a);
}

// Two coordinates in [-1, 1] as 16 bits each.
SHARED_FN UV pack_normal(FV x, FV y) {
    return unorm_code(fma(x, fv(0.5f), fv(0.5f)), 65535.0f) |
           (unorm_code(fma(y, fv(0.5f), fv(0.5f)), 65535.0f) << 16);
}

SHARED_FN FV unorm8(UV code) { return lane_to_float(code) * (1.0f / 255.0f); }

// [-1, 1] of a 16-bit UNORM.
SHARED_FN FV snorm_of_unorm16(UV code) {
    return fma(lane_to_float(code), fv(2.0f / 65535.0f), fv(-1.0f));
}

// Reflectance of a code, the square root in 255ths: 51 is DIELECTRIC_F0 exactly.
SHARED_FN FV reflectance_of(UV code) {
    FV root = lane_to_float(code);
    return root * root * (1.0f / 65025.0f);
}

SHARED_FN FV3 unorm8_color(UV rgba) {
    return fv3(unorm8(rgba & 255u), unorm8((rgba >> 8) & 255u), unorm8((rgba >> 16) & 255u));
}

SHARED_FN UV pack_reflectance(FV3 c, FV fourth) {
    FV3 root = fv3(lane_sqrt(c.x), lane_sqrt(c.y), lane_sqrt(c.z));
    return pack_linear(root, unorm_code(fourth, 255.0f));
}

SHARED_FN FV3 unpack_reflectance(UV code) {
    return fv3(reflectance_of(code & 255u), reflectance_of((code >> 8) & 255u),
               reflectance_of((code >> 16) & 255u));
}

SHARED_FN UV pack_specular(Surface s) { return pack_reflectance(s.specular, s.specular_f90); }

SHARED_FN Surface unpack_specular(UV code, Surface s) {
    s.specular = unpack_reflectance(code);
    s.specular_f90 = unorm8(code >> 24);
    return s;
}

SHARED_FN UV pack_coat(Surface s) {
    return unorm_code(s.coat, 65535.0f) | (unorm_code(s.coat_roughness, 65535.0f) << 16);
}

SHARED_FN Surface unpack_coat(UV code, Surface s) {
    s.coat = lane_to_float(code & 0xffffu) * (1.0f / 65535.0f);
    s.coat_roughness = lane_to_float(code >> 16) * (1.0f / 65535.0f);
    return s;
}

SHARED_FN UV pack_coat_normal(Surface s) {
    FV3 octahedral = octahedral_encode(s.coat_normal);
    return pack_normal(octahedral.x, octahedral.y);
}

SHARED_FN Surface unpack_coat_normal(UV code, Surface s) {
    s.coat_normal =
        octahedral_decode(snorm_of_unorm16(code & 0xffffu), snorm_of_unorm16(code >> 16));
    return s;
}

SHARED_FN UV pack_sheen(Surface s) { return pack_reflectance(s.sheen, s.sheen_roughness); }

SHARED_FN Surface unpack_sheen(UV code, Surface s) {
    s.sheen = unpack_reflectance(code);
    s.sheen_roughness = unorm8(code >> 24);
    return s;
}

SHARED_FN UV pack_transmission(Surface s) { return pack_reflectance(s.tint, s.transmission); }

SHARED_FN Surface unpack_transmission(UV code, Surface s) {
    s.tint = unpack_reflectance(code);
    s.transmission = unorm8(code >> 24);
    return s;
}

// Perpendicular to the normal. It turns with the normal, so that a normal's rounding turns no
// tangent by more; only near -z, where surfaces are seen from behind, it is not unit.
SHARED_FN FV3 tangent_axis(FV3 n) {
    // Frisvad 2012, "Building an Orthonormal Basis from a 3D Unit Vector Without Normalization".
    FV a = n.x / max(fv(1.0f) + n.z, fv(1e-3f));
    return fv3(fma(-n.x, a, fv(1.0f)), -n.y * a, -n.x);
}

// The line of the tangent in the plane of the normal: of +-(x, y), y >= 0, x / (|x| + y). Its code
// is within 0.0018 degrees.
SHARED_FN UV pack_anisotropy(Surface s) {
    FV3 axis = tangent_axis(s.normal);
    FV x = dot3(s.tangent, axis), y = dot3(s.tangent, cross3(s.normal, axis));
    FV sum = max(max(x, -x) + max(y, -y), fv(1e-20f));
    FV line = lane_select(y >= fv(0.0f), x, -x) / sum;
    return unorm_code(fma(line, fv(0.5f), fv(0.5f)), 65535.0f) |
           (unorm_code(s.anisotropy, 65535.0f) << 16);
}

SHARED_FN Surface unpack_anisotropy(UV code, Surface s) {
    FV3 axis = tangent_axis(s.normal);
    FV3 other = cross3(s.normal, axis);
    FV x = snorm_of_unorm16(code & 0xffffu);
    FV y = fv(1.0f) - max(x, -x);
    FV3 t =
        fv3(fma(x, axis.x, y * other.x), fma(x, axis.y, y * other.y), fma(x, axis.z, y * other.z));
    s.tangent = scale3(t, lane_rsqrt(max(dot3(t, t), fv(1e-20f))));
    s.anisotropy = lane_to_float(code >> 16) * (1.0f / 65535.0f);
    return s;
}

// The optional planes of four bytes that all layouts but `full` may have, beside PLANE_MATERIAL:
// whether the scene's G-buffers have it, its number, and its functions.
#define PACKED_PLANES(PLANE)                                                        \
    PLANE(HAS_SPECULAR, PLANE_SPECULAR, pack_specular, unpack_specular)             \
    PLANE(HAS_CLEARCOAT, PLANE_COAT, pack_coat, unpack_coat)                        \
    PLANE(HAS_COAT_NORMAL, PLANE_COAT_NORMAL, pack_coat_normal, unpack_coat_normal) \
    PLANE(HAS_SHEEN, PLANE_SHEEN, pack_sheen, unpack_sheen)                         \
    PLANE(HAS_ANISOTROPY, PLANE_ANISOTROPY, pack_anisotropy, unpack_anisotropy)     \
    PLANE(HAS_TRANSMISSION, PLANE_TRANSMISSION, pack_transmission, unpack_transmission)
#endif
