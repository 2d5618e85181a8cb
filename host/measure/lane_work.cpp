// SPDX-License-Identifier: Apache-2.0
#include "host/measure/stage_model.h"
#include "kernels/shared/evaluate_modes.h"

/// The operations of kernels/shared/evaluate.h and kernels/device/gbuffer.h, counted by their
/// source. Checked against PoCL 3.1's AVX2 code of shade's inner loop, where an inverse square root
/// is two instructions: Lambert 23, with spot lights 34, Blinn-Phong 85, PBR 68, with metals 71
/// vector arithmetic instructions a light; by the source 23, 33, 84, 68, 71 (two negations are the
/// rest).
namespace kilolux {
namespace {

// n.l from an unnormalised direction 3 + 1, at least 0 1, lit 1.
constexpr LaneWork kIncident = {6.0};
// sum.x..z with one weight.
constexpr LaneWork kAddScaled = {3.0};
// Half vector 3, its length's square 3, at least 1, inverse square root.
constexpr LaneWork kHalfVector = {8.0, 1.0};
// pow_one_minus(): 1 - h 2, exponent and mantissa 7, f 3, logarithm 12, product 3, exponential 13.
constexpr LaneWork kPowOneMinus = {40.0};

LaneWork blinn_phong_work() {
    // d 3, its square 3, half of it 1, at most 1 1; weight 1.
    return kHalfVector + LaneWork{9.0} + kPowOneMinus + 2.0 * kAddScaled;
}

LaneWork pbr_work(bool metallic) {
    // n x h 6, its square 3, times 1/h^2 2, at most 1 1, GGX 1; Smith 2 and a square root 1, both
    // 2; lobe 2 and a division 1; Schlick 3 + 1 + 1 + 1 + 2, 1 - f 1.
    const LaneWork lobe = {30.0, 0.0, 1.0, 1.0};
    // Diffuse weight 1; specular weight 2 (dielectric), or 1 and its untinted part's 1.
    const LaneWork sums = (metallic ? 3.0 : 2.0) * kAddScaled + LaneWork{3.0};
    return kHalfVector + lobe + sums;
}

LaneWork incident_work(const KernelFeatures& kernels) {
    switch (kernels.shading) {
        case SHADING_BLINN_PHONG:
            return kIncident + blinn_phong_work();
        case SHADING_PBR:
            return kIncident + pbr_work(kernels.metallic);
        default:
            return kIncident + kAddScaled;
    }
}

// Position, normal and albedo from what the layout stores.
LaneWork decode_work(uint gbuffer) {
    // Codes 2, conversion 2, scale 2; octahedron: |x|, |y| 2, z 2, fold 1, signs 6, square 3, root,
    // inverse, scale 3.
    const LaneWork unpack = {6.0};
    const LaneWork octahedral = {19.0, 0.0, 1.0, 1.0};
    const LaneWork position = {3.0};
    const LaneWork albedo_codes = {5.0};
    switch (gbuffer) {
        case GBUFFER_FULL:
            return {};
        case GBUFFER_HALF:
            // World positions 3 + 9; normals 9 + 4, inverse root, 3; albedo 5 + 6.
            return {39.0, 1.0};
        case GBUFFER_NORMAL_XY:
            return position + unpack + LaneWork{4.0, 0.0, 1.0} + albedo_codes;
        case GBUFFER_OCT_2X4:
            return octahedral + albedo_codes;
        default:
            return position + unpack + octahedral + albedo_codes;
    }
}

// make_shading_point() and finish_shading() beyond Lambert's.
LaneWork gloss_work(const KernelFeatures& kernels) {
    if (kernels.shading == SHADING_LAMBERT) return {};
    // Roughness 3, its squares 3, distance to the eye 4 and an inverse root 1, direction 3; the
    // sums' three more components 6.
    LaneWork work = {20.0, 1.0};
    if (kernels.shading == SHADING_BLINN_PHONG) {
        // Exponent: a division and 1; lobe: a division; specular 1 + 3, beside the diffuse term.
        work = work + LaneWork{7.0, 0.0, 0.0, 2.0};
    } else {
        // n.v 4, Smith 3 and a root 1; lobe 1, channels 3 * 2 beside the diffuse term.
        work = work + LaneWork{15.0, 0.0, 1.0};
    }
    // Decoding 3, dielectric share 1, base 3, F0 4; Fresnel sums 6 and specular 3.
    if (kernels.metallic) work = work + LaneWork{kernels.shading == SHADING_PBR ? 20.0 : 14.0};
    return work;
}

}  // namespace

LaneWork operator+(const LaneWork& a, const LaneWork& b) {
    return {a.instructions + b.instructions, a.rsqrts + b.rsqrts, a.sqrts + b.sqrts,
            a.divisions + b.divisions};
}

LaneWork operator*(double times, const LaneWork& work) {
    return {times * work.instructions, times * work.rsqrts, times * work.sqrts,
            times * work.divisions};
}

LaneWork work_of_evaluation(const KernelFeatures& kernels) {
    // v 3, d^2 3, in ranges 1, window 2, at least d_min 1, inverse root 1, strength 2.
    LaneWork work = LaneWork{13.0, 1.0} + incident_work(kernels);
    // Along the axis 3, cosine 1, cone 4, its square 1, strength 1.
    if (kernels.spot_lights) work = work + LaneWork{10.0};
    return work;
}

LaneWork work_of_directional(const KernelFeatures& kernels) {
    // Its direction is a unit vector and its strength 1: n.l needs two operations less.
    return incident_work(kernels) + LaneWork{-2.0};
}

LaneWork work_of_pixel(const KernelFeatures& kernels) {
    // Pixel centre 2, depth 2 and a division 1, slice 4, mask 4; the list's sum joins 3 and is
    // selected 3; albedo / pi 6, ambient 3, background 3.
    LaneWork work =
        LaneWork{31.0, 0.0, 0.0, 1.0} + decode_work(kernels.gbuffer) + gloss_work(kernels);
    // Emissive: codes 5, scale 3, sum 3.
    if (kernels.material) work = work + LaneWork{11.0};
    if (kernels.occlusion) work = work + LaneWork{3.0};
    return work;
}

}  // namespace kilolux
