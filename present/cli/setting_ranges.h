// SPDX-License-Identifier: Apache-2.0
// Ranges of the settings that command-line options and the window's saved values share.
#pragma once

#include <cstdint>
#include <limits>

#include "present/cli/option_values.h"

namespace kilolux {

inline constexpr double kMaxFloat = std::numeric_limits<float>::max();

inline constexpr NumberRange kAboveZeroRange{0.0, kMaxFloat, true};
inline constexpr NumberRange kZeroOrAboveRange{0.0, kMaxFloat};
inline constexpr NumberRange kExposureRange{-126.0, 126.0};  // [EV]
inline constexpr NumberRange kBloomRange{0.0, 1.0};
inline constexpr NumberRange kAmbientRange = kZeroOrAboveRange;

inline constexpr CountRange kEdgeRange{1, 65536};  // of a picture [pixel]
inline constexpr CountRange kSamplesRange{1, 65536};
inline constexpr CountRange kAnisotropyRange{1, 16};
// 31 bits: indices of lights and offsets of lists have 32 on the device.
inline constexpr CountRange kLightsRange{0, std::uint64_t{1} << 31};
inline constexpr CountRange kLightSeedRange{0, std::numeric_limits<std::uint64_t>::max()};
inline constexpr CountRange kTilesRange{1, 4096};
inline constexpr CountRange kSlicesRange{1, 64};  // per octave of depth

}  // namespace kilolux
