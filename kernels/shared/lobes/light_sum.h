// SPDX-License-Identifier: Apache-2.0
// Sums over lights, in blocks by light index.
#ifndef KILOLUX_SHARED_LOBES_LIGHT_SUM_H
#define KILOLUX_SHARED_LOBES_LIGHT_SUM_H
#include "kernels/shared/surface.h"
#include "kernels/shared/types.h"

// Lights whose contributions are summed before they join the pixel's sum; by light index, so that a
// light that contributes 0 changes no bit wherever it is listed. Error of k terms: (64 + k/64) u,
// where one running sum has k u (Higham 2002, "Accuracy and Stability of Numerical
// Algorithms", 4.2).
#define SUM_BLOCK_LOG2 6

#if defined(__cplusplus)
namespace kilolux {
#endif

// The terms of a BRDF that have sums of their own. TERM(has, member): whether the model has it.
#define LIGHT_TERMS(TERM) \
    TERM(true, diffuse)   \
    TERM(SHADING != SHADING_LAMBERT, specular)

#define TERM_MEMBER(has, term) FV3 term;
// Sums over lights of intensity * falloff * n.l, weighted as each term of the BRDF needs.
SHARED_PLAIN_STRUCT(LightSum){
    LIGHT_TERMS(TERM_MEMBER)  // linear Rec. 709
};

// Upper bounds of the factors of the light that a surface receives.
SHARED_PLAIN_STRUCT(LightBound) {
    FV cosine;       // n.h
    FV fresnel;      // Schlick's (1 - v.h)^5
    FV3 diffuse;     // the diffuse sum
    FV3 all;         // the sum of intensity / distance^2
    FV3 irradiance;  // that sum times n.l, or `all` where n.l is unknown
};

SHARED_FN LightSum zero_sum() {
    LightSum sum;
#define ZERO_TERM(has, term) sum.term = zero3();
    LIGHT_TERMS(ZERO_TERM)
    return sum;
}

SHARED_FN LightSum add_sums(LightSum a, LightSum b) {
#define ADD_TERM(has, term) \
    if (has) a.term = add3(a.term, b.term);
    LIGHT_TERMS(ADD_TERM)
    return a;
}

SHARED_FN LightSum add_weighted(LightSum sum, FV weight, LightSum b) {
#define ADD_WEIGHTED_TERM(has, term) \
    if (has) sum.term = add3(sum.term, scale3(b.term, weight));
    LIGHT_TERMS(ADD_WEIGHTED_TERM)
    return sum;
}

// Adds `b`, each channel times its share.
SHARED_FN LightSum add_tinted(LightSum sum, FV3 share, LightSum b) {
#define ADD_TINTED_TERM(has, term)                                                             \
    if (has) {                                                                                 \
        sum.term = fv3(fma(share.x, b.term.x, sum.term.x), fma(share.y, b.term.y, sum.term.y), \
                       fma(share.z, b.term.z, sum.term.z));                                    \
    }
    LIGHT_TERMS(ADD_TINTED_TERM)
    return sum;
}

SHARED_FN FV3 add_scaled(FV3 sum, FV weight, float4 color) {
    return fv3(fma(weight, fv(color.x), sum.x), fma(weight, fv(color.y), sum.y),
               fma(weight, fv(color.z), sum.z));
}

// Adds the light of a colour, from the weights of its terms.
SHARED_FN LightSum add_colored(LightSum sum, LightSum weights, float4 color) {
#define ADD_COLORED_TERM(has, term)                                   \
    if (has) {                                                        \
        sum.term = fv3(fma(weights.term.x, fv(color.x), sum.term.x),  \
                       fma(weights.term.y, fv(color.y), sum.term.y),  \
                       fma(weights.term.z, fv(color.z), sum.term.z)); \
    }
    LIGHT_TERMS(ADD_COLORED_TERM)
    return sum;
}

// A sum over lights in progress. Lights come in ascending order of their index; a finished block
// joins the total.
SHARED_PLAIN_STRUCT(RunningSum) {
    LightSum total;
    LightSum block;
    uint block_number;
};

SHARED_FN RunningSum start_sum(LightSum total) {
    RunningSum sum;
    sum.total = total;
    sum.block = zero_sum();
    sum.block_number = 0u;
    return sum;
}

// The sum before light `index` joins its block: a new block where the index enters one.
SHARED_FN RunningSum enter_block(RunningSum sum, uint index) {
    uint block_number = index >> SUM_BLOCK_LOG2;
    if (block_number != sum.block_number) {
        sum.block_number = block_number;
        sum.total = add_sums(sum.total, sum.block);
        sum.block = zero_sum();
    }
    return sum;
}

SHARED_FN LightSum finish_sum(RunningSum sum) { return add_sums(sum.total, sum.block); }

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
