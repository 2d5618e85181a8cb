// SPDX-License-Identifier: Apache-2.0
// Operations on the lane types that OpenCL C spells differently for each width.
#ifndef KILOLUX_DEVICE_LANES_H
#define KILOLUX_DEVICE_LANES_H
#include "kernels/shared/types.h"

// LANES(T, f): a vector of type T whose lane i is f(i). Gathers and ramps are written with it.
#if VW == 1
#define LANES(T, f) ((T)(f(0)))
#define load_lanes(p) (*(p))
#define store_lanes(v, p) (*(p) = (v))
#elif VW == 2
#define LANES(T, f) ((T)(f(0), f(1)))
#elif VW == 4
#define LANES(T, f) ((T)(f(0), f(1), f(2), f(3)))
#elif VW == 8
#define LANES(T, f) ((T)(f(0), f(1), f(2), f(3), f(4), f(5), f(6), f(7)))
#elif VW == 16
#define LANES(T, f)                                                                              \
    ((T)(f(0), f(1), f(2), f(3), f(4), f(5), f(6), f(7), f(8), f(9), f(10), f(11), f(12), f(13), \
         f(14), f(15)))
#endif

#if VW > 1
#define load_lanes(p) KX_CONCAT(vload, VW)(0, p)
#define store_lanes(v, p) KX_CONCAT(vstore, VW)(v, 0, p)
#endif

#define LANE_NUMBER(i) i
#define lane_numbers LANES(UV, LANE_NUMBER)
#define to_float_lanes(u) KX_CONCAT(convert_, FV)(u)
#define to_uint_lanes(x) KX_CONCAT(convert_, UV)(x)
#define to_int_lanes(x) KX_CONCAT(convert_, IV)(x)

static inline bool any_lane(MASK mask) { return any_of(mask); }

// A comparison's value as a mask of all bits, whatever the width: scalars compare to 0 or 1.
#if VW == 1
#define full_mask(m) (-(IV)((m) != 0))
#else
#define full_mask(m) (m)
#endif

static inline float min_lane(FV v) {
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

static inline float max_lane(FV v) { return -min_lane(-v); }

static inline uint min_lane_uint(UV v) {
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

static inline uint sum_lanes(UV v) {
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
#endif
