// SPDX-License-Identifier: Apache-2.0
// The built-in functions that kernels call, declared as in opencl-c.h, for PoCL alone. Each of its
// builds reads the 18,000 lines of opencl-c.h, even of a program that it has kept. With
// -D_OPENCL_H_, that header's guard, a build reads this file only. Declare a function here for all
// of its types: a missing name is an error, but a missing type may be converted to one that is
// here.
#ifndef KILOLUX_DEVICE_POCL_BUILTINS_H
#define KILOLUX_DEVICE_POCL_BUILTINS_H
#define POCL_OVERLOADED __attribute__((overloadable))
#define POCL_CONSTANT __attribute__((overloadable, const))
#define POCL_READING __attribute__((overloadable, pure))

#define POCL_EACH_SIZE(DECLARE, T) \
    DECLARE(T, ) DECLARE(T, 2) DECLARE(T, 3) DECLARE(T, 4) DECLARE(T, 8) DECLARE(T, 16)

// Of floats.
#define POCL_ONE_ARGUMENT(f, n) float##n POCL_CONSTANT f(float##n);
#define POCL_TWO_ARGUMENTS(f, n) float##n POCL_CONSTANT f(float##n, float##n);
#define POCL_THREE_ARGUMENTS(f, n) float##n POCL_CONSTANT f(float##n, float##n, float##n);
#define POCL_WITH_AN_INT(f, n) float##n POCL_CONSTANT f(float##n, int##n);
#define POCL_TO_INT(f, n) int##n POCL_CONSTANT f(float##n);
POCL_EACH_SIZE(POCL_ONE_ARGUMENT, atan)
POCL_EACH_SIZE(POCL_ONE_ARGUMENT, ceil)
POCL_EACH_SIZE(POCL_ONE_ARGUMENT, fabs)
POCL_EACH_SIZE(POCL_ONE_ARGUMENT, floor)
POCL_EACH_SIZE(POCL_ONE_ARGUMENT, log2)
POCL_EACH_SIZE(POCL_ONE_ARGUMENT, rsqrt)
POCL_EACH_SIZE(POCL_ONE_ARGUMENT, sqrt)
POCL_EACH_SIZE(POCL_ONE_ARGUMENT, native_recip)
POCL_EACH_SIZE(POCL_ONE_ARGUMENT, native_rsqrt)
POCL_EACH_SIZE(POCL_ONE_ARGUMENT, native_sqrt)
POCL_EACH_SIZE(POCL_TWO_ARGUMENTS, atan2)
POCL_EACH_SIZE(POCL_TWO_ARGUMENTS, copysign)
POCL_EACH_SIZE(POCL_TWO_ARGUMENTS, fmax)
POCL_EACH_SIZE(POCL_TWO_ARGUMENTS, fmin)
POCL_EACH_SIZE(POCL_TWO_ARGUMENTS, pow)
POCL_EACH_SIZE(POCL_THREE_ARGUMENTS, fma)
POCL_EACH_SIZE(POCL_WITH_AN_INT, ldexp)
POCL_EACH_SIZE(POCL_TO_INT, ilogb)
// All sizes: a scalar would become a vector where that has the only declaration.
#define POCL_PRODUCTS(T)           \
    float POCL_CONSTANT dot(T, T); \
    float POCL_CONSTANT length(T);
POCL_PRODUCTS(float)
POCL_PRODUCTS(float2)
POCL_PRODUCTS(float3)
POCL_PRODUCTS(float4)

// Of floats and integers.
#define POCL_BOUNDS(T, n)               \
    T##n POCL_CONSTANT min(T##n, T##n); \
    T##n POCL_CONSTANT max(T##n, T##n); \
    T##n POCL_CONSTANT clamp(T##n, T##n, T##n);
#define POCL_CHOICE(T, n)                          \
    T##n POCL_CONSTANT select(T##n, T##n, int##n); \
    T##n POCL_CONSTANT select(T##n, T##n, uint##n);
#define POCL_CONVERTED(T, n)                      \
    T##n POCL_CONSTANT convert_##T##n(uchar##n);  \
    T##n POCL_CONSTANT convert_##T##n(ushort##n); \
    T##n POCL_CONSTANT convert_##T##n(int##n);    \
    T##n POCL_CONSTANT convert_##T##n(uint##n);   \
    T##n POCL_CONSTANT convert_##T##n(float##n);
#define POCL_BITS(T, n)           \
    T##n POCL_CONSTANT clz(T##n); \
    T##n POCL_CONSTANT popcount(T##n);
#define POCL_PRODUCT(T, n) T##n POCL_CONSTANT mul_hi(T##n, T##n);
#define POCL_EACH_TYPE(DECLARE)     \
    POCL_EACH_SIZE(DECLARE, uchar)  \
    POCL_EACH_SIZE(DECLARE, ushort) \
    POCL_EACH_SIZE(DECLARE, int) POCL_EACH_SIZE(DECLARE, uint) POCL_EACH_SIZE(DECLARE, float)
POCL_EACH_TYPE(POCL_CONVERTED)
POCL_EACH_TYPE(POCL_BOUNDS)
POCL_EACH_SIZE(POCL_BOUNDS, ulong)
POCL_EACH_SIZE(POCL_BOUNDS, long)
POCL_EACH_SIZE(POCL_CHOICE, int)
POCL_EACH_SIZE(POCL_CHOICE, uint)
POCL_EACH_SIZE(POCL_CHOICE, float)
POCL_EACH_SIZE(POCL_BITS, int)
POCL_EACH_SIZE(POCL_BITS, uint)
POCL_EACH_SIZE(POCL_PRODUCT, int)
POCL_EACH_SIZE(POCL_PRODUCT, uint)
POCL_EACH_SIZE(POCL_PRODUCT, long)
POCL_EACH_SIZE(POCL_PRODUCT, ulong)
#define POCL_ABS(T, n) u##T##n POCL_CONSTANT abs(T##n);
POCL_EACH_SIZE(POCL_ABS, int)
POCL_EACH_SIZE(POCL_ABS, long)

// Memory.
#define POCL_LOADED_FROM(SPACE, T, n) T##n POCL_READING vload##n(size_t, const SPACE T*);
#define POCL_LOADED(T, n)              \
    POCL_LOADED_FROM(__global, T, n)   \
    POCL_LOADED_FROM(__local, T, n)    \
    POCL_LOADED_FROM(__constant, T, n) \
    POCL_LOADED_FROM(__private, T, n)
#define POCL_STORED(T, n)                                      \
    void POCL_OVERLOADED vstore##n(T##n, size_t, __global T*); \
    void POCL_OVERLOADED vstore##n(T##n, size_t, __local T*);  \
    void POCL_OVERLOADED vstore##n(T##n, size_t, __private T*);
#define POCL_EACH_VECTOR(DECLARE, T) \
    DECLARE(T, 2) DECLARE(T, 3) DECLARE(T, 4) DECLARE(T, 8) DECLARE(T, 16)
#define POCL_MEMORY_OF(T)            \
    POCL_EACH_VECTOR(POCL_LOADED, T) \
    POCL_EACH_VECTOR(POCL_STORED, T) \
    void POCL_OVERLOADED prefetch(const __global T*, size_t);
POCL_MEMORY_OF(float)
POCL_MEMORY_OF(int)
POCL_MEMORY_OF(uint)
POCL_MEMORY_OF(uchar)
POCL_MEMORY_OF(ushort)
#define POCL_HALVES(T, n)                                          \
    T##n POCL_READING vload_half##n(size_t, const __global half*); \
    void POCL_OVERLOADED vstore_half##n##_rte(T##n, size_t, __global half*);
POCL_EACH_SIZE(POCL_HALVES, float)

#define POCL_ATOMIC_IN(SPACE, T)                        \
    T POCL_OVERLOADED atomic_add(volatile SPACE T*, T); \
    T POCL_OVERLOADED atomic_inc(volatile SPACE T*);    \
    T POCL_OVERLOADED atomic_dec(volatile SPACE T*);    \
    T POCL_OVERLOADED atomic_and(volatile SPACE T*, T); \
    T POCL_OVERLOADED atomic_or(volatile SPACE T*, T);  \
    T POCL_OVERLOADED atomic_min(volatile SPACE T*, T); \
    T POCL_OVERLOADED atomic_max(volatile SPACE T*, T);
POCL_ATOMIC_IN(__global, int)
POCL_ATOMIC_IN(__local, int)
POCL_ATOMIC_IN(__global, uint)
POCL_ATOMIC_IN(__local, uint)

// Images with a sampler: what the limits of texture units are measured with.
float4 POCL_READING read_imagef(read_only image2d_t, sampler_t, int2);
float4 POCL_READING read_imagef(read_only image2d_t, sampler_t, float2);
void POCL_OVERLOADED write_imagef(write_only image2d_t, int2, float4);

// Work-items.
size_t POCL_CONSTANT get_global_id(uint);
size_t POCL_CONSTANT get_global_size(uint);
size_t POCL_CONSTANT get_group_id(uint);
size_t POCL_CONSTANT get_local_id(uint);
size_t POCL_CONSTANT get_local_size(uint);
size_t POCL_CONSTANT get_num_groups(uint);
void __attribute__((overloadable, convergent)) barrier(cl_mem_fence_flags);
#endif
