// SPDX-License-Identifier: Apache-2.0
// The dialect in which C++, OpenCL C and GLSL 4.50 share declarations and formulas.
//
// A shared struct is a sequence of 16-byte rows: one float4 or uint4, or four 32-bit scalars. Then
// C++ alignment, OpenCL C and std430 agree by construction; tests/opencl/layout_test.cpp and
// tests/raster/shared_test.cpp ask the devices.
//
// A shared function is written on the lane type FV: one float in C++ and GLSL, VW floats in OpenCL
// C (VW is the device's lane width, set at build time). MASK is the result of comparing two FV.
// Such a function uses only + - * /, fma, min, max and the functions of this file, so that its text
// means the same in the three languages. Operations on lanes are called lane_*; UV is a uint for
// each.
//
// A large struct is a parameter IN(T) p, read as AT(p).member and passed as REF(x): a pointer in
// OpenCL C, whose compilers copy structs that are passed by value.
//
// Two switches choose other instructions where a device has faster ones:
// FAST_RSQRT   lane_rsqrt is one instruction (GPUs) rather than a root and a division (CPUs)
// NATIVE_MATH  roots and quotients as the hardware makes them, of unstated accuracy (OpenCL only)
#ifndef KILOLUX_SHARED_TYPES_H
#define KILOLUX_SHARED_TYPES_H

#ifndef FAST_RSQRT
#define FAST_RSQRT 0
#endif
#ifndef NATIVE_MATH
#define NATIVE_MATH 0
#endif

#if defined(__OPENCL_C_VERSION__) || defined(__OPENCL_VERSION__)
#define SHARED_STRUCT(Name)   \
    typedef struct Name Name; \
    struct __attribute__((aligned(16))) Name
#define SHARED_PLAIN_STRUCT(Name) \
    typedef struct Name Name;     \
    struct Name
#define SHARED_ASSERT(tag, cond) typedef char shared_assert_##tag[(cond) ? 1 : -1]
#define SHARED_FN static inline
#define SHARED_CONSTANT(type, name, value) __constant type name = value
#define IN(T) const T*
#define INOUT(T) T*
#define AT(p) (*(p))
#define REF(x) (&(x))
#ifndef VW
#define VW 1
#endif
#define KX_CONCAT_(a, b) a##b
#define KX_CONCAT(a, b) KX_CONCAT_(a, b)
#if VW == 1
#define FV float
#define IV int
#define UV uint
#else
#define FV KX_CONCAT(float, VW)
#define IV KX_CONCAT(int, VW)
#define UV KX_CONCAT(uint, VW)
#endif
#define MASK IV
#define fv(s) ((FV)(s))
// `a` where the mask is set, else `b`.
#define lane_select(mask, a, b) select((FV)(b), (FV)(a), (MASK)(mask))
#define float_bits(x) as_uint(x)
#define bits_float(x) as_float(x)
#if NATIVE_MATH
#define lane_sqrt(x) native_sqrt(x)
#define lane_rsqrt(x) native_rsqrt(x)
#define lane_divide(a, b) ((a)*native_recip(b))
#else
#define lane_sqrt(x) sqrt(x)
#define lane_rsqrt(x) rsqrt(x)
#define lane_divide(a, b) ((a) / (b))
#endif
#define float_of(x) ((float)(x))
#define uint_of(x) ((uint)(x))
#define make_float2(x, y) ((float2)(x, y))
#define make_float3(x, y, z) ((float3)(x, y, z))
#define make_float4(x, y, z, w) ((float4)(x, y, z, w))
#define lane_uint(s) ((UV)(s))
#define lane_select_uint(mask, a, b) select((UV)(b), (UV)(a), (MASK)(mask))
#define lane_select_mask(mask, a, b) (((mask) & (a)) | (~(mask) & (b)))
#define lane_not(mask) (~(mask))
#define lane_and(a, b) ((a) & (b))
#define lane_bits(x) KX_CONCAT(as_, UV)(x)
#define lane_from_bits(x) KX_CONCAT(as_, FV)(x)
// Truncated to an integer (two's complement), and back.
#define lane_truncate(x) KX_CONCAT(as_, UV)(KX_CONCAT(convert_, IV)(x))
#define lane_from_int(x) KX_CONCAT(convert_, FV)(KX_CONCAT(as_, IV)(x))

// Whether the mask is set in any lane. By halves: PoCL's any() asks lane by lane.
static inline bool lane_any(MASK m) {
#if VW == 16
    int8 a = m.lo | m.hi;
    int4 b = a.lo | a.hi;
    int2 c = b.lo | b.hi;
    return (c.x | c.y) != 0;
#elif VW == 8
    int4 b = m.lo | m.hi;
    int2 c = b.lo | b.hi;
    return (c.x | c.y) != 0;
#elif VW == 4
    int2 c = m.lo | m.hi;
    return (c.x | c.y) != 0;
#elif VW == 2
    return (m.x | m.y) != 0;
#else
    return m != 0;
#endif
}

#elif defined(__cplusplus)
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
namespace kilolux {
using uchar = std::uint8_t;
using uint = std::uint32_t;
using ulong = std::uint64_t;
struct alignas(16) float4 {
    float x, y, z, w;
};
struct alignas(16) uint4 {
    uint x, y, z, w;
};
using FV = float;
using MASK = bool;
using UV = uint;
using std::floor;
using std::fma;
using std::max;
using std::min;
inline float fv(float s) { return s; }
inline bool lane_any(bool mask) { return mask; }
inline uint lane_uint(uint s) { return s; }
inline float lane_select(bool mask, float a, float b) { return mask ? a : b; }
inline uint float_bits(float x) { return std::bit_cast<uint>(x); }
inline float bits_float(uint x) { return std::bit_cast<float>(x); }
inline float lane_sqrt(float x) { return std::sqrt(x); }
inline float lane_rsqrt(float x) { return 1.0f / std::sqrt(x); }
inline float lane_divide(float a, float b) { return a / b; }
inline float float_of(uint x) { return static_cast<float>(x); }
inline uint uint_of(float x) { return static_cast<uint>(x); }
inline float4 make_float4(float x, float y, float z, float w) { return {x, y, z, w}; }
inline uint lane_bits(float x) { return std::bit_cast<uint>(x); }
inline float lane_from_bits(uint x) { return std::bit_cast<float>(x); }
inline uint lane_truncate(float x) { return static_cast<uint>(static_cast<int>(x)); }
inline float lane_from_int(uint x) { return static_cast<float>(static_cast<int>(x)); }
}  // namespace kilolux
#define SHARED_STRUCT(Name) struct alignas(16) Name
#define SHARED_PLAIN_STRUCT(Name) struct Name
#define SHARED_ASSERT(tag, cond) static_assert(cond, #tag)
#define SHARED_FN inline
#define SHARED_CONSTANT(type, name, value) inline constexpr type name = value

#else  // GLSL 4.50
#define float4 vec4
#define uint4 uvec4
#define SHARED_STRUCT(Name) struct Name
#define SHARED_PLAIN_STRUCT(Name) struct Name
#define SHARED_ASSERT(tag, cond)
#define SHARED_FN
#define SHARED_CONSTANT(type, name, value) const type name = value
#define IN(T) T
#define INOUT(T) inout T
#define AT(p) p
#define REF(x) x
#define FV float
#define MASK bool
#define fv(s) float(s)
#define lane_select(mask, a, b) ((mask) ? (a) : (b))
#define lane_any(mask) (mask)
#define lane_sqrt sqrt
#define lane_rsqrt inversesqrt
#define lane_divide(a, b) ((a) / (b))
#define float_of(x) float(x)
#define uint_of(x) uint(x)
#define float2 vec2
#define float3 vec3
#define make_float2 vec2
#define make_float3 vec3
#define make_float4 vec4
#define fabs abs
#define float_bits floatBitsToUint
#define bits_float uintBitsToFloat
#define UV uint
#define lane_uint(s) uint(s)
#define lane_bits floatBitsToUint
#define lane_from_bits uintBitsToFloat
#define lane_truncate(x) uint(int(x))
#define lane_from_int(x) float(int(x))
#define lane_to_float(u) float(u)
#define lane_to_uint(x) uint(x)
#define lane_mask(m) (m)
#define lane_not(mask) (!(mask))
#define lane_and(a, b) ((a) && (b))
#define lane_select_uint(mask, a, b) ((mask) ? (a) : (b))
#define lane_select_mask(mask, a, b) ((mask) ? (a) : (b))
#define lane_max(x) (x)
#endif

#if defined(__cplusplus)
namespace kilolux {
#endif

// Three lanes-wide components: a point, direction or colour of VW pixels at once.
SHARED_PLAIN_STRUCT(FV3) { FV x, y, z; };

SHARED_FN FV3 fv3(FV x, FV y, FV z) {
    FV3 v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}

// Four: a colour and its alpha.
SHARED_PLAIN_STRUCT(FV4) { FV x, y, z, w; };

SHARED_FN FV dot3(FV3 a, FV3 b) { return fma(a.z, b.z, fma(a.y, b.y, a.x * b.x)); }

SHARED_FN FV3 add3(FV3 a, FV3 b) { return fv3(a.x + b.x, a.y + b.y, a.z + b.z); }

SHARED_FN FV3 sub3(FV3 a, FV3 b) { return fv3(a.x - b.x, a.y - b.y, a.z - b.z); }

SHARED_FN FV3 scale3(FV3 a, FV s) { return fv3(a.x * s, a.y * s, a.z * s); }

SHARED_FN FV3 cross3(FV3 a, FV3 b) {
    return fv3(fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)),
               fma(a.x, b.y, -(a.y * b.x)));
}

SHARED_FN FV3 select3(MASK mask, FV3 a, FV3 b) {
    return fv3(lane_select(mask, a.x, b.x), lane_select(mask, a.y, b.y),
               lane_select(mask, a.z, b.z));
}

#if !defined(__cplusplus)
// 1 / x within 2^-22, by sums and products alone: the same bits on every device. For the magnitudes
// from 1e-37 to 1e37.
SHARED_FN FV lane_reciprocal(FV x) {
    UV bits = lane_bits(x);
    UV guess = (0x7ef311c7u - (bits & 0x7fffffffu)) | (bits & 0x80000000u);  // within an eighth
    FV r = lane_from_bits(guess);
    r = fma(r, fma(-x, r, fv(1.0f)), r);
    r = fma(r, fma(-x, r, fv(1.0f)), r);
    return fma(r, fma(-x, r, fv(1.0f)), r);
}
#endif

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
