// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kilolux {

constexpr int kGlyphWidth = 5;   // [pixel]
constexpr int kGlyphHeight = 7;  // [pixel]

/// Whether a character has ink at a pixel of its box. Digits, letters (as capitals) and
/// ".,:-+/*%=()_"; others are blank.
bool has_ink(char character, int x, int y);

}  // namespace kilolux
