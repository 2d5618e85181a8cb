// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kilolux {

/// `text` with ASCII capitals made small, in any locale.
inline std::string lower(std::string_view text) {
    std::string out(text);
    for (char& c : out) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return out;
}

/// The parts of `text` between separators, empty ones included: at least one.
inline std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (;;) {
        const std::size_t end = text.find(separator);
        parts.push_back(text.substr(0, end));
        if (end == std::string_view::npos) return parts;
        text.remove_prefix(end + 1);
    }
}

/// `text` without spaces, tabs and line ends at its ends.
inline std::string_view trim(std::string_view text) {
    constexpr std::string_view kSpaces = " \t\r\n";
    const std::size_t first = text.find_first_not_of(kSpaces);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kSpaces) - first + 1);
}

/// "5" of "+5".
inline std::string_view without_plus(std::string_view text) {
    return text.size() > 1 && text[0] == '+' && text[1] != '-' ? text.substr(1) : text;
}

/// The number that all of `text` is, without sign "+"; none for any other text.
template <typename Number>
std::optional<Number> number_of(std::string_view text, auto... base) {
    Number value{};
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), value, base...);
    const bool is_all = error == std::errc() && end == text.data() + text.size();
    return is_all ? std::optional(value) : std::nullopt;
}

/// The same with a sign "+", too: "+5" is 5.
template <typename Number>
std::optional<Number> signed_number_of(std::string_view text) {
    return number_of<Number>(without_plus(text));
}

/// A word as a shell reads it back: in single quotes, unless it is a plain one.
std::string shell_word(std::string_view word);

/// A whole number, also as "5k", "2M" (powers of 1000) or "1e6"; none for any other text.
std::optional<std::uint64_t> count_of(std::string_view text);

/// "a, b, c"
inline std::string joined(const std::vector<std::string>& words,
                          std::string_view separator = ", ") {
    std::string out;
    for (const std::string& word : words) {
        if (!out.empty()) out += separator;
        out += word;
    }
    return out;
}

}  // namespace kilolux
