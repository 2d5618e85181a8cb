// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace kilolux {

/// A number in [0, 1) of a lattice point: the same for points that are a `period` apart.
double lattice_value(int x, int y, int period, std::uint32_t seed);

/// Gradient noise (Perlin 2002, "Improving noise") in about [-1, 1] with a period for
/// each coordinate, 0 on the lattice.
double gradient_noise(glm::dvec2 p, glm::ivec2 period, std::uint32_t seed);

/// `octaves` of gradient noise, each of twice the frequency and half the amplitude, in about [-1,
/// 1]; `p` in [0, 1) covers one period with `period` lattice cells of the first octave.
double fractal_noise(glm::dvec2 p, int period, int octaves, std::uint32_t seed);

}  // namespace kilolux
