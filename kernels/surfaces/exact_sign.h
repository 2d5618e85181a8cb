// SPDX-License-Identifier: Apache-2.0
// The side of an edge that a pixel lies on, by integers: never wrong, the same on every device.
//
// An edge a -> b of a triangle, both vertices as seen from the eye, and the ray d of a pixel: the
// side is the sign of det(a, b, d). A vector's length does not matter, so each is written in units
// of 2^-40 of the power of two below its largest coordinate; smaller parts are cut off. The result
// is a function of the vector alone, so triangles that share a vertex have the same integers, and
// all later steps are exact. The determinant's products need 42 + 42 + 42 bits.
//
// Where the determinant is 0 the pixel lies on the edge. Then its ray counts as moved by an
// infinitesimal step along x, and by a far smaller one along y: the sign is that of the first
// derivative that is not 0, and the opposite for b -> a. So rays are in general position, and of a
// closed mesh's triangles about a vertex or along an edge exactly one contains the ray.
#ifndef KILOLUX_DEVICE_EXACT_SIGN_H
#define KILOLUX_DEVICE_EXACT_SIGN_H

#define FIXED_BITS 40

typedef struct Fixed3 {
    long x, y, z;
} Fixed3;

// high * 2^64 + low.
typedef struct Wide {
    long high;
    ulong low;
} Wide;

static inline int biased_exponent(float c) { return (int)(as_uint(c) >> 23 & 0xffu); }

// c in units of 2^-FIXED_BITS of 2^(largest - 127), cut off; 0 for denormal numbers.
static inline long fixed_coordinate(float c, int largest) {
    int exponent = biased_exponent(c);
    int shift = FIXED_BITS - 23 + exponent - largest;
    if (exponent == 0 || shift <= -24) return 0;
    long magnitude = (long)((as_uint(c) & 0x7fffffu) | 0x800000u);
    magnitude = shift >= 0 ? magnitude << shift : magnitude >> -shift;
    return (as_uint(c) >> 31) != 0u ? -magnitude : magnitude;
}

static inline Fixed3 fixed_of(float3 v) {
    int largest = max(max(biased_exponent(v.x), biased_exponent(v.y)), biased_exponent(v.z));
    Fixed3 out = {fixed_coordinate(v.x, largest), fixed_coordinate(v.y, largest),
                  fixed_coordinate(v.z, largest)};
    return out;
}

static inline Wide wide_product(long a, long b) {
    Wide out = {mul_hi(a, b), (ulong)a * (ulong)b};
    return out;
}

static inline Wide wide_sum(Wide a, Wide b) {
    Wide out;
    out.low = a.low + b.low;
    out.high = a.high + b.high + (out.low < a.low ? 1 : 0);
    return out;
}

static inline int wide_sign(Wide a) {
    if (a.high < 0) return -1;
    return (a.high != 0 || a.low != 0) ? 1 : 0;
}

// a b - c d.
static inline Wide difference_of_products(long a, long b, long c, long d) {
    return wide_sum(wide_product(a, b), wide_product(-c, d));
}

// a / 2^FIXED_BITS, rounded down, where that fits; and the rest, not negative.
static inline long upper_part(Wide a) {
    return (long)((ulong)a.high << (64 - FIXED_BITS) | a.low >> FIXED_BITS);
}
static inline long lower_part(Wide a) { return (long)(a.low & ((1ul << FIXED_BITS) - 1ul)); }

// a x b.
typedef struct WideNormal {
    Wide x, y, z;
} WideNormal;

static inline WideNormal wide_cross(Fixed3 a, Fixed3 b) {
    WideNormal out = {difference_of_products(a.y, b.z, a.z, b.y),
                      difference_of_products(a.z, b.x, a.x, b.z),
                      difference_of_products(a.x, b.y, a.y, b.x)};
    return out;
}

// The sign of n . d.
static inline int sign_along(WideNormal n, Fixed3 d) {
    Wide upper =
        wide_sum(wide_sum(wide_product(upper_part(n.x), d.x), wide_product(upper_part(n.y), d.y)),
                 wide_product(upper_part(n.z), d.z));
    Wide lower =
        wide_sum(wide_sum(wide_product(lower_part(n.x), d.x), wide_product(lower_part(n.y), d.y)),
                 wide_product(lower_part(n.z), d.z));
    long carry = upper_part(lower);
    Wide carried = {carry < 0 ? -1 : 0, (ulong)carry};
    int sign = wide_sign(wide_sum(upper, carried));
    return sign != 0 ? sign : (lower_part(lower) != 0 ? 1 : 0);
}

// The side of edge a -> b that the ray d lies on: 1 or -1; 0 only where a and b lie on one line
// through the eye.
static inline int edge_side(Fixed3 a, Fixed3 b, Fixed3 d) {
    WideNormal n = wide_cross(a, b);
    int side = sign_along(n, d);
    if (side == 0) side = wide_sign(n.x);
    if (side == 0) side = wide_sign(n.y);
    return side;
}
#endif
