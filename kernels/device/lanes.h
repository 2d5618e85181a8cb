// SPDX-License-Identifier: Apache-2.0
// Operations on the lane types that OpenCL C spells differently for each width.
#ifndef KILOLUX_DEVICE_LANES_H
#define KILOLUX_DEVICE_LANES_H
#include "kernels/shared/types.h"

// LANES(T, f, a, b): a vector of type T whose lane i is f(i, a, b). Gathers and ramps are written
// with it.
#if VW == 1
#define LANES(T, f, a, b) ((T)(f(0, a, b)))
#define lane_load(p) (*(p))
#define lane_store(v, p) (*(p) = (v))
#elif VW == 2
#define LANES(T, f, a, b) ((T)(f(0, a, b), f(1, a, b)))
#elif VW == 4
#define LANES(T, f, a, b) ((T)(f(0, a, b), f(1, a, b), f(2, a, b), f(3, a, b)))
#elif VW == 8
#define LANES(T, f, a, b)                                                                    \
    ((T)(f(0, a, b), f(1, a, b), f(2, a, b), f(3, a, b), f(4, a, b), f(5, a, b), f(6, a, b), \
         f(7, a, b)))
#elif VW == 16
#define LANES(T, f, a, b)                                                                        \
    ((T)(f(0, a, b), f(1, a, b), f(2, a, b), f(3, a, b), f(4, a, b), f(5, a, b), f(6, a, b),     \
         f(7, a, b), f(8, a, b), f(9, a, b), f(10, a, b), f(11, a, b), f(12, a, b), f(13, a, b), \
         f(14, a, b), f(15, a, b)))
#endif

#if VW > 1
#define lane_load(p) KX_CONCAT(vload, VW)(0, p)
#define lane_store(v, p) KX_CONCAT(vstore, VW)(v, 0, p)
#endif

// table[index[i]] for each lane.
#define ELEMENT_AT(i, table, index) (table)[(index)[i]]
#define lane_gather(T, table, index) LANES(T, ELEMENT_AT, table, index)

#define LANE_NUMBER(i, a, b) i
#define lane_numbers LANES(UV, LANE_NUMBER, 0, 0)
#define lane_to_float(u) KX_CONCAT(convert_, FV)(u)
#define lane_to_uint(x) KX_CONCAT(convert_, UV)(x)
#define lane_to_int(x) KX_CONCAT(convert_, IV)(x)
#if VW == 1
#define lane_to_uchar(u) convert_uchar(u)
#else
#define lane_to_uchar(u) KX_CONCAT(convert_uchar, VW)(u)
#endif

// A comparison's value as a mask of all bits, whatever the width: scalars compare to 0 or 1.
#if VW == 1
#define lane_mask(m) (-(IV)((m) != 0))
#else
#define lane_mask(m) (m)
#endif

static inline float lane_min(FV v) {
#if VW == 16
    float8 a = min(v.lo, v.hi);
    float4 b = min(a.lo, a.hi);
    float2 c = min(b.lo, b.hi);
    return min(c.x, c.y);
#elif VW == 8
    float4 b = min(v.lo, v.hi);
    float2 c = min(b.lo, b.hi);
    return min(c.x, c.y);
#elif VW == 4
    float2 c = min(v.lo, v.hi);
    return min(c.x, c.y);
#elif VW == 2
    return min(v.x, v.y);
#else
    return v;
#endif
}

static inline float lane_max(FV v) { return -lane_min(-v); }

static inline uint lane_min_uint(UV v) {
#if VW == 16
    uint8 a = min(v.lo, v.hi);
    uint4 b = min(a.lo, a.hi);
    uint2 c = min(b.lo, b.hi);
    return min(c.x, c.y);
#elif VW == 8
    uint4 b = min(v.lo, v.hi);
    uint2 c = min(b.lo, b.hi);
    return min(c.x, c.y);
#elif VW == 4
    uint2 c = min(v.lo, v.hi);
    return min(c.x, c.y);
#elif VW == 2
    return min(v.x, v.y);
#else
    return v;
#endif
}

static inline uint lane_sum(UV v) {
#if VW == 16
    uint8 a = v.lo + v.hi;
    uint4 b = a.lo + a.hi;
    uint2 c = b.lo + b.hi;
    return c.x + c.y;
#elif VW == 8
    uint4 b = v.lo + v.hi;
    uint2 c = b.lo + b.hi;
    return c.x + c.y;
#elif VW == 4
    uint2 c = v.lo + v.hi;
    return c.x + c.y;
#elif VW == 2
    return v.x + v.y;
#else
    return v;
#endif
}

// A bit for each lane of the mask.
static inline uint lane_ballot(MASK mask) {
    return lane_sum(KX_CONCAT(as_, UV)(mask) & ((UV)(1u) << lane_numbers));
}
#endif
