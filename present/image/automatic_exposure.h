// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kilolux {

/// Chooses an exposure by the light of a picture.
class ExposureMeter {
 public:
    ExposureMeter();

    /// Takes the next rows of the picture, `radiance` of 3 floats a pixel.
    void add(std::span<const float> radiance);

    /// See automatic_exposure().
    float exposure() const;

 private:
    struct Bin {
        std::uint64_t pixels = 0;
        float most = 0.0f;  // of their largest channels
    };

    double log_sum_ = 0.0;  // log2 of the luminance of lit pixels
    std::uint64_t count_ = 0;
    std::vector<Bin> brightest_;  // lit pixels by the upper bits of their largest channel
};

/// Exposure [EV] that gives the lit pixels of a linear picture, `radiance` of 3 floats each, a log
/// average luminance of middle grey, 0.18 (Reinhard et al. 2002, "Photographic Tone Reproduction
/// for Digital Images", equation 1), or less, so that at most 2 % of them have a channel above 1:
/// this keeps a dark model's highlights, whose light is known to 1 in 4096. Rounded to hundredths,
/// so that the printed value is the one in use; 0 for a black picture.
float automatic_exposure(std::span<const float> radiance);

}  // namespace kilolux
