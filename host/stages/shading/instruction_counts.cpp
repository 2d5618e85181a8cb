// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shading/instruction_counts.h"

#include <algorithm>

#include "kernels/shared/evaluate_modes.h"

// tests/measure/roofline/instruction_counts_test.cpp compiles evaluate.h with a type that counts.
// PoCL 3.1's AVX2 code of shade's inner loop has 21, 83 and 68 vector instructions a light for
// Lambert, Blinn-Phong and PBR (an inverse square root is two).
namespace kilolux {
namespace {

// sum.x..z with one weight.
constexpr InstructionCounts kAddScaled = {3.0};
// Half vector 3, its length's square 3, at least 1.
constexpr InstructionCounts kHalfVector = {7.0};
// pow_of_cos2(): near the peak or not 2, quotient 1 and a division, exponent and mantissa 6,
// logarithm 12, product 1, exponential 13.
constexpr InstructionCounts kPowOfCos2 = {36.0, 0.0, 0.0, 1.0};

// n x h 6, its square 3.
constexpr InstructionCounts kHalfVectorSine = {9.0};
// GGX 2; Smith 2 and a square root 1, both 2; lobe 3 and a division 1.
constexpr InstructionCounts kGgx = {11.0, 0.0, 1.0, 1.0};

InstructionCounts sheen_instructions() {
    // n.h 3 and its square 1; lambda: the cosine or its complement 4, the other 1, l 4 with a
    // division, its mirror 2, exponential 15; sum 1, a division 1, none from behind 2, weight 1;
    // E: 4, exponential 13; the rest 2 and the base's weight 1.
    return InstructionCounts{55.0, 0.0, 0.0, 2.0} + 2.0 * kPowOfCos2;
}

InstructionCounts blinn_phong_instructions() {
    // n.h 3 and its square 1, n x h 6 and its square 3, none from behind 2; weight 1.
    return kHalfVector + InstructionCounts{16.0} + kPowOfCos2 + 2.0 * kAddScaled;
}

InstructionCounts pbr_instructions(const KernelFeatures& kernels) {
    // Schlick 3, inverse root 1, 2 + 3, 1 - f 1.
    const InstructionCounts lobe = kGgx + InstructionCounts{10.0, 1.0};
    // Diffuse weight 1; specular weight 2, or 2 a channel where reflectance varies; 2 more where it
    // does so at grazing angles.
    const bool varies = kernels.metallic || kernels.specular;
    const InstructionCounts sums =
        2.0 * kAddScaled + InstructionCounts{(varies ? 7.0 : 3.0) + (kernels.specular ? 2.0 : 0.0)};
    // h^4 1.
    InstructionCounts work = kHalfVector + InstructionCounts{1.0} + kHalfVectorSine + lobe + sums;
    // The lobe without Schlick's 10 but with its share 1; that of the light below 1.
    if (kernels.clearcoat) work = work + kGgx + InstructionCounts{2.0};
    // n.l 3 + 1 + 1, falloff 1.
    if (kernels.clearcoat && kernels.coat_normals)
        work = work + InstructionCounts{6.0} + kHalfVectorSine;
    // b.h 3, its square 1, GGX 1; t.l 4, its square 1, Smith 1.
    if (kernels.anisotropy) work = work + InstructionCounts{11.0};
    // A colour 3; specular weights of their own a channel.
    if (kernels.sheen) work = work + sheen_instructions() + InstructionCounts{varies ? 3.0 : 5.0};
    return work;
}

InstructionCounts incident_instructions(const KernelFeatures& kernels) {
    switch (kernels.shading) {
        case SHADING_BLINN_PHONG:
            return blinn_phong_instructions();
        case SHADING_PBR:
            return pbr_instructions(kernels);
        default:
            return kAddScaled;
    }
}

// From the distance's square and n.v to a unit direction's n.l and falloff.
InstructionCounts falloff_instructions(const KernelFeatures& kernels) {
    // At least d_min 1; root 1, cube 1, product 1, division 1.
    if (kernels.shading != SHADING_PBR) return {5.0, 0.0, 1.0, 1.0};
    // At least d_min 1, inverse root 1, n.l 1, products 3.
    return {6.0, 1.0};
}

// Cone 3 + 1 + 4, its square 1, window 1; all but PBR divide for the inverse distance.
InstructionCounts cone_instructions(const KernelFeatures& kernels) {
    if (kernels.shading != SHADING_PBR) return {11.0, 0.0, 0.0, 1.0};
    return {10.0};
}

}  // namespace

InstructionCounts operator+(const InstructionCounts& a, const InstructionCounts& b) {
    return {a.total + b.total, a.rsqrts + b.rsqrts, a.sqrts + b.sqrts, a.divisions + b.divisions};
}

InstructionCounts operator*(double times, const InstructionCounts& counts) {
    return {times * counts.total, times * counts.rsqrts, times * counts.sqrts,
            times * counts.divisions};
}

bool leaves_early(const KernelFeatures& kernels) { return kernels.shading != SHADING_LAMBERT; }

InstructionCounts range_test_instructions() {
    // v 3, d^2 3, x 1, window 2, comparison 1.
    return {10.0};
}

InstructionCounts evaluation_instructions(const KernelFeatures& kernels) {
    // n.v 3 + 1; Lambert does not compare.
    const InstructionCounts n_dot_v = {leaves_early(kernels) ? 4.0 : 3.0};
    InstructionCounts work = range_test_instructions() + n_dot_v + falloff_instructions(kernels) +
                             incident_instructions(kernels);
    if (kernels.spot_lights) work = work + cone_instructions(kernels);
    return work;
}

InstructionCounts directional_instructions(const KernelFeatures& kernels) {
    // n.l 3 + 1.
    return InstructionCounts{4.0} + incident_instructions(kernels);
}

InstructionCounts shading_instructions(const StageCounts& c) {
    const double left_early = c.evaluations - c.full_evaluations;
    return left_early * range_test_instructions() +
           c.full_evaluations * evaluation_instructions(c.kernels) +
           c.surface_pixels * c.directional_lights * directional_instructions(c.kernels);
}

InstructionCounts seen_instructions(const StageCounts& c) {
    const double directional = std::min(c.shadow_seen, c.surface_pixels * c.directional_lights);
    const double listed = leaves_early(c.kernels) ? c.full_evaluations : c.evaluations;
    return std::min(c.shadow_seen - directional, listed) * evaluation_instructions(c.kernels) +
           directional * directional_instructions(c.kernels);
}

double full_evaluations(const StageCounts& c) {
    return c.full_evaluations + c.surface_pixels * c.directional_lights;
}

}  // namespace kilolux
