// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/photometry/photometry_text.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/base/text.h"

namespace kilolux {
namespace {

constexpr double kMostAngles = 100000;

bool is_gap(char c) { return static_cast<unsigned char>(c) <= ' ' || c == ','; }

std::string_view line_of(std::string_view text) {
    return text.substr(0, std::min(text.find('\n'), text.size()));
}

double value_of(std::string_view word) {
    const bool has_sign = word.starts_with('+');
    return number_of<double>(has_sign ? word.substr(1) : word)
        .value_or(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

std::string shown_word(std::string_view word) {
    std::string out(word.substr(0, 40));
    std::replace_if(
        out.begin(), out.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return out;
}

double line_value(std::string_view line) {
    std::string word(trim(line));
    std::replace(word.begin(), word.end(), ',', '.');
    return value_of(word);
}

std::string_view PhotometryText::take_line() {
    std::string_view line = line_of(left_);
    drop(std::min(line.size() + 1, left_.size()));
    while (!line.empty() && is_gap(line.back())) line.remove_suffix(1);
    return line;
}

double PhotometryText::number(std::string_view what) {
    const std::string_view field = next_field(what);
    const bool is_line = fields_ == PhotometryFields::lines;
    const double value = is_line ? line_value(field) : value_of(field);
    if (!std::isfinite(value)) fail("{} is '{}', must be a number", what, shown_word(field));
    if (!is_line) drop(field.size());
    return value;
}

double PhotometryText::positive(std::string_view what) {
    const double value = number(what);
    if (!(value > 0.0)) fail("{} is {}, must be greater than 0", what, value);
    return value;
}

std::size_t PhotometryText::count(std::string_view what, double least) {
    const double value = number(what);
    if (value != std::floor(value) || value < least || value > kMostAngles) {
        fail("{} is {}, must be a whole number from {} to {}", what, value, least, kMostAngles);
    }
    return static_cast<std::size_t>(value);
}

// Numbers take a character each and one between two, so a short file cannot claim much.
void PhotometryText::check_room(std::string_view what, std::size_t count) const {
    if (2 * count <= left_.size() + 1) return;
    fail("{} {}s are more than the {} characters that are left hold", count, what, left_.size());
}

std::vector<double> PhotometryText::numbers(std::string_view what, std::size_t count) {
    check_room(what, count);
    std::vector<double> out;
    const std::string one = "a " + std::string(what);
    while (out.size() < count) out.push_back(number(one));
    return out;
}

std::vector<double> PhotometryText::angles(std::string_view what, std::size_t count) {
    check_room(what, count);
    std::vector<double> out;
    const std::string one = "a " + std::string(what);
    while (out.size() < count) {
        const double next = number(one);
        if (!out.empty() && !(next > out.back())) {
            fail("{}s must rise, {} follows {}", what, next, out.back());
        }
        out.push_back(next);
    }
    return out;
}

std::vector<double> PhotometryText::candela(std::size_t count, double factor) {
    check_room("candela value", count);
    std::vector<double> out;
    double peak = 0.0;
    while (out.size() < count) {
        const double value = number("a candela value");
        if (value < 0.0) fail("a candela value is {}, must be at least 0", value);
        out.push_back(value * factor);
        peak = std::max(peak, out.back());
    }
    if (!(peak > 0.0 && peak < 1e30)) {
        fail("the largest intensity is {} cd, must be greater than 0 and below 1e30", peak);
    }
    return out;
}

void PhotometryText::expect_end() {
    if (fields_ == PhotometryFields::lines) drop(line_of(left_).size());
    skip_gaps();
    if (!at_end()) fail("'{}' follows the last candela value", shown_word(next_word()));
}

std::string_view PhotometryText::next_field(std::string_view what) {
    if (fields_ == PhotometryFields::words) {
        skip_gaps();
    } else if (has_begun_) {
        drop(std::min(line_of(left_).size() + 1, left_.size()));
    }
    has_begun_ = true;
    if (at_end()) fail("the file ends where {} should be", what);
    return fields_ == PhotometryFields::words ? next_word() : trim(line_of(left_));
}

std::string_view PhotometryText::next_word() const {
    const auto end = std::find_if(left_.begin(), left_.end(), is_gap);
    return left_.substr(0, static_cast<std::size_t>(end - left_.begin()));
}

void PhotometryText::skip_gaps() {
    const auto end = std::find_if_not(left_.begin(), left_.end(), is_gap);
    drop(static_cast<std::size_t>(end - left_.begin()));
}

void PhotometryText::drop(std::size_t characters) {
    line_ += static_cast<std::size_t>(
        std::count(left_.begin(), left_.begin() + static_cast<std::ptrdiff_t>(characters), '\n'));
    left_.remove_prefix(characters);
}

}  // namespace kilolux
