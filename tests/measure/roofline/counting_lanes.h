// SPDX-License-Identifier: Apache-2.0
// Replaces kernels/shared/types.h with lanes that count: it adds up, by kind of operation, what the
// shared formulas and kernels of this translation unit compute on FV. Operations of which no
// operand varies between lights or iterations are loop invariants and do not count.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "host/stages/shading/instruction_counts.h"
#include "kernels/shared/types.h"  // whose macros and guard are replaced below

namespace counting {

using uint = std::uint32_t;

struct Counts {
    kilolux::InstructionCounts instructions;
    double loaded_lanes = 0.0, stored_lanes = 0.0;
};
inline Counts counts;

// A number, and whether it varies.
template <typename T>
struct Counted {
    T value{};
    bool varies = false;
};
using FV = Counted<float>;
using MASK = Counted<bool>;
using UV = Counted<uint>;

template <typename T, typename... Operands>
Counted<T> counted(T value, const Operands&... operands) {
    const bool varies = (operands.varies || ...);
    counts.instructions.total += varies ? 1.0 : 0.0;
    return {value, varies};
}

template <typename T>
Counted<T> operator+(Counted<T> a, Counted<T> b) {
    return counted(T(a.value + b.value), a, b);
}
template <typename T>
Counted<T> operator-(Counted<T> a, Counted<T> b) {
    return counted(T(a.value - b.value), a, b);
}
template <typename T>
Counted<T> operator*(Counted<T> a, Counted<T> b) {
    return counted(T(a.value * b.value), a, b);
}
inline FV operator/(FV a, FV b) {
    counts.instructions.divisions += a.varies || b.varies ? 1.0 : 0.0;
    return counted(a.value / b.value, a, b);
}
inline FV operator-(FV a) { return {-a.value, a.varies}; }
inline MASK operator<(FV a, FV b) { return counted(a.value < b.value, a, b); }
inline MASK operator>(FV a, FV b) { return counted(a.value > b.value, a, b); }
// Of a light, the same in all lanes.
inline bool operator<(FV a, float b) { return a.value < b; }
inline bool operator>(FV a, float b) { return a.value > b; }
inline UV operator-(UV a, uint b) { return counted(a.value - b, a); }
inline UV operator-(uint a, UV b) { return counted(a - b.value, b); }
inline UV operator&(UV a, uint b) { return counted(a.value & b, a); }
inline UV operator<<(UV a, uint b) { return counted(a.value << b, a); }
inline FV& operator+=(FV& a, FV b) { return a = a + b; }

inline FV fv(float s) { return {s, false}; }
inline FV fv(FV s) { return s; }
inline FV fma(FV a, FV b, FV c) { return counted(std::fma(a.value, b.value, c.value), a, b, c); }
inline FV max(FV a, FV b) { return counted(std::fmax(a.value, b.value), a, b); }
inline FV min(FV a, FV b) { return counted(std::fmin(a.value, b.value), a, b); }
inline FV sqrt(FV a) {
    counts.instructions.sqrts += a.varies ? 1.0 : 0.0;
    return counted(std::sqrt(a.value), a);
}
inline FV rsqrt(FV a) {
    counts.instructions.rsqrts += a.varies ? 1.0 : 0.0;
    return counted(1.0f / std::sqrt(a.value), a);
}
inline FV lane_divide(FV a, FV b) { return a / b; }
inline FV lane_sqrt(FV a) { return sqrt(a); }
inline FV lane_rsqrt(FV a) { return rsqrt(a); }
inline FV lane_select(MASK m, FV a, FV b) { return counted(m.value ? a.value : b.value, m, a, b); }
inline bool lane_any(MASK mask) { return mask.value; }
// Conversions count, reinterpretations do not.
inline UV lane_bits(FV a) { return {std::bit_cast<uint>(a.value), a.varies}; }
inline FV lane_from_bits(UV a) { return {std::bit_cast<float>(a.value), a.varies}; }
inline FV lane_from_bits(uint a) { return {std::bit_cast<float>(a), false}; }
inline UV lane_truncate(FV a) { return counted(uint(int(a.value)), a); }
inline FV lane_from_int(UV a) { return counted(float(int(a.value)), a); }

struct FV3 {
    FV x, y, z;
};
inline FV3 fv3(FV x, FV y, FV z) { return {x, y, z}; }
inline FV dot3(FV3 a, FV3 b) { return fma(a.z, b.z, fma(a.y, b.y, a.x * b.x)); }
inline FV3 add3(FV3 a, FV3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline FV3 scale3(FV3 a, FV s) { return {a.x * s, a.y * s, a.z * s}; }
inline FV3 cross3(FV3 a, FV3 b) {
    return {fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)), fma(a.x, b.y, -(a.y * b.x))};
}

// The values of a light, which vary.
struct float4 {
    FV x, y, z, w;
};
inline FV lane_of(float x) { return {x}; }
inline FV lane_of(FV x) { return x; }
template <typename X, typename Y, typename Z>
float4 make_float4(X x, Y y, Z z, float w) {
    return {lane_of(x), lane_of(y), lane_of(z), lane_of(w)};
}
inline float4 varying4(float x, float y, float z, float w) {
    return {{x, true}, {y, true}, {z, true}, {w, true}};
}

}  // namespace counting

#undef SHARED_STRUCT
#undef SHARED_PLAIN_STRUCT
#undef SHARED_ASSERT
#undef SHARED_FN
#define SHARED_STRUCT(Name) struct Name
#define SHARED_PLAIN_STRUCT(Name) struct Name
#define SHARED_ASSERT(tag, cond) static_assert(true)
#define SHARED_FN inline
