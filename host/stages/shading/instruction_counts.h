// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/stage_info.h"

/// Instructions of lights at pixels, as kernels/shared/evaluate.h spells them: a test compiles it
/// with a type that counts.
namespace kilolux {

InstructionCounts operator+(const InstructionCounts& a, const InstructionCounts& b);
InstructionCounts operator*(double times, const InstructionCounts& counts);

/// Whether evaluate() returns early for a light that is out of range in all lanes: EARLY_OUT.
bool leaves_early(const KernelFeatures& kernels);

/// Instructions for a light that is out of range: evaluate() up to its early return.
InstructionCounts range_test_instructions();

/// Instructions for one light at one pixel: the whole of evaluate().
InstructionCounts evaluation_instructions(const KernelFeatures& kernels);

/// Instructions for a directional light at one pixel: evaluate_directional().
InstructionCounts directional_instructions(const KernelFeatures& kernels);

/// Instructions for all lights of all pixels' lists. With exact shadows seen_instructions(): only
/// lights that are seen are evaluated, and directional ones first, as they take least.
InstructionCounts shading_instructions(const StageCounts& counts);
InstructionCounts seen_instructions(const StageCounts& counts);

/// Number of lights evaluated in full, summed over all pixels.
double full_evaluations(const StageCounts& counts);

}  // namespace kilolux
