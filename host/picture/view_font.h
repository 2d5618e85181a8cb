// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kilolux {

constexpr int kGlyphWidth = 5;   // [pixel]
constexpr int kGlyphHeight = 7;  // [pixel]

/// Whether a character of the legend's font has ink at a pixel of its box. Digits, ".-+/*%" and the
/// capital letters that units are written in; others are blank.
bool has_ink(char character, int x, int y);

}  // namespace kilolux
