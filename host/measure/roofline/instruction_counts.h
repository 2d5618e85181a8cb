// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/features.h"

namespace kilolux {

/// Operations of one lane, as kernels/shared/evaluate.h and kernels/device/gbuffer.h spell them:
/// fma counts as one; comparisons, selections, conversions and bit operations count one each;
/// negations, loads, stores, loop counters and what does not change in the loop count nothing.
struct InstructionCounts {
    double total = 0.0;  // special functions included, as one each
    double rsqrts = 0.0;
    double sqrts = 0.0;
    double divisions = 0.0;
    bool operator==(const InstructionCounts&) const = default;
};

InstructionCounts operator+(const InstructionCounts& a, const InstructionCounts& b);
InstructionCounts operator*(double times, const InstructionCounts& counts);

/// Whether evaluate() returns early for a light that is out of range in all lanes: EARLY_OUT.
bool leaves_early(const KernelFeatures& kernels);

/// Of a light that is out of range: evaluate() up to its early return.
InstructionCounts range_test_instructions();

/// Of one light at one pixel: the whole of evaluate().
InstructionCounts evaluation_instructions(const KernelFeatures& kernels);

/// Of a directional light at one pixel: evaluate_directional().
InstructionCounts directional_instructions(const KernelFeatures& kernels);

/// Of one drawn pixel without its lights: decoding, make_shading_point() and finish_shading().
InstructionCounts pixel_instructions(const KernelFeatures& kernels);

}  // namespace kilolux
