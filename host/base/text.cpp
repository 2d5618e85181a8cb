// SPDX-License-Identifier: Apache-2.0
#include "host/base/text.h"

#include <cmath>

namespace kilolux {

std::string shell_word(std::string_view word) {
    constexpr std::string_view kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./:,+@%=";
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string_view::npos) {
        return std::string(word);
    }
    std::string out = "'";
    for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

std::optional<std::uint64_t> count_of(std::string_view text) {
    if (const auto value = number_of<std::uint64_t>(text)) return value;
    double unit = 1.0;
    if (text.ends_with('k')) unit = 1e3;
    if (text.ends_with('M')) unit = 1e6;
    if (unit > 1.0) text.remove_suffix(1);
    const double value = unit * number_of<double>(text).value_or(-1.0);
    // A double holds every whole number up to 2^53.
    const bool whole = value >= 0.0 && value <= 0x1p53 && value == std::floor(value);
    return whole ? std::optional(static_cast<std::uint64_t>(value)) : std::nullopt;
}

}  // namespace kilolux
