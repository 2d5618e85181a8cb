// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/scene/lights/environment.h"
#include "kernels/shared/types.h"

namespace kilolux {

/// An environment made ready to light any surface at once: split sum (Karis 2013, "Real Shading in
/// Unreal Engine 4") for the pbr model of kernels/shared/evaluate.h.
struct PrefilteredEnvironment {
    std::vector<float> texels;  // RGB of all levels
    // Width, height and first texel of each level: light through GGX lobes of roughness 0 to 1 in
    // equal steps, seen along their axis; then irradiance / pi.
    std::vector<uint4> levels;
    // [table_size][table_size][3], columns by n.v, rows by roughness, from 0 to 1: what a surface
    // returns of f0 and of f90, and what its diffuse light loses to Schlick's rise.
    std::vector<float> table;
    unsigned table_size = 0;
};

/// An environment of at most `width` texels a row: means, weighted by solid angle, of squares of
/// texels, and where the height is odd of all that a texel covers.
Environment shrunk(const Environment& from, int width);

/// Takes a few seconds of processor time, spread over all cores.
PrefilteredEnvironment prefiltered(const Environment& environment);

}  // namespace kilolux
