// SPDX-License-Identifier: Apache-2.0
// IES files (ANSI/IES LM-63): keywords, TILT, then numbers apart by spaces, lines or commas.
#include "host/scene/lights/ies_file.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <string_view>

#include "host/base/error.h"
#include "host/base/text.h"

namespace kilolux {
namespace {

constexpr double kMostAngles = 100000;

bool is_gap(char c) { return static_cast<unsigned char>(c) <= ' ' || c == ','; }

// A word of the file as a message may show it.
std::string shown(std::string_view word) {
    std::string out(word.substr(0, 40));
    std::replace_if(
        out.begin(), out.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return out;
}

class IesText {
 public:
    IesText(std::string_view text, std::string where) : left_(text), where_(std::move(where)) {}

    template <typename... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> what, Args&&... args) const {
        throw Error(fmt::format("{}: line {}: {}", where_, line_,
                                fmt::format(what, std::forward<Args>(args)...)));
    }

    bool at_end() const { return left_.empty(); }

    std::string_view take_line() {
        const std::size_t end = std::min(left_.find('\n'), left_.size());
        std::string_view line = left_.substr(0, end);
        drop(std::min(end + 1, left_.size()));
        while (!line.empty() && is_gap(line.back())) line.remove_suffix(1);
        return line;
    }

    double number(std::string_view what) {
        skip_gaps();
        if (at_end()) fail("the file ends where {} should be", what);
        const std::string_view word = next_word();
        const auto value = number_of<double>(word.front() == '+' ? word.substr(1) : word);
        if (!value || !std::isfinite(*value)) {
            fail("{} is '{}', must be a number", what, shown(word));
        }
        drop(word.size());
        return *value;
    }

    double positive(std::string_view what) {
        const double value = number(what);
        if (!(value > 0.0)) fail("{} is {}, must be greater than 0", what, value);
        return value;
    }

    std::size_t count(std::string_view what, double least) {
        const double value = number(what);
        if (value != std::floor(value) || value < least || value > kMostAngles) {
            fail("{} is {}, must be a whole number from {} to {}", what, value, least, kMostAngles);
        }
        return static_cast<std::size_t>(value);
    }

    std::vector<double> numbers(std::string_view what, std::size_t count) {
        // A number takes two characters, so a short file cannot claim much.
        if (count > left_.size()) {
            fail("{} {}s are more than the {} characters that are left hold", count, what,
                 left_.size());
        }
        std::vector<double> out;
        const std::string one = "a " + std::string(what);
        while (out.size() < count) out.push_back(number(one));
        return out;
    }

    std::vector<double> angles(std::string_view what, std::size_t count) {
        std::vector<double> out = numbers(what, count);
        for (std::size_t i = 1; i < count; ++i) {
            if (out[i] > out[i - 1]) continue;
            fail("{}s must rise, {} follows {}", what, out[i], out[i - 1]);
        }
        return out;
    }

    void expect_end() {
        skip_gaps();
        if (!at_end()) fail("'{}' follows the last candela value", shown(next_word()));
    }

 private:
    std::string_view next_word() const {
        const auto end = std::find_if(left_.begin(), left_.end(), is_gap);
        return left_.substr(0, static_cast<std::size_t>(end - left_.begin()));
    }
    void skip_gaps() {
        const auto end = std::find_if_not(left_.begin(), left_.end(), is_gap);
        drop(static_cast<std::size_t>(end - left_.begin()));
    }
    void drop(std::size_t characters) {
        line_ += static_cast<std::size_t>(std::count(
            left_.begin(), left_.begin() + static_cast<std::ptrdiff_t>(characters), '\n'));
        left_.remove_prefix(characters);
    }

    std::string_view left_;
    std::size_t line_ = 1;
    std::string where_;
};

// LM-63-1991 and the older edition without a first line of its own multiply by a second ballast
// factor; later ones reserve its place, and the last keeps the kind of file there.
bool has_photometric_factor(std::string_view first_line) {
    return !first_line.starts_with("IESNA:LM-63-") && !first_line.starts_with("IES:LM-63-");
}

// Whether a second ballast factor counts. Reads to where the numbers start.
bool skip_to_numbers(IesText& file) {
    std::string_view line = file.take_line();
    const bool factor = has_photometric_factor(line);
    while (!line.starts_with("TILT=")) {
        if (file.at_end()) file.fail("there is no line TILT=, so this is no IES file (LM-63)");
        line = file.take_line();
    }
    std::string_view tilt = line.substr(5);
    while (!tilt.empty() && is_gap(tilt.front())) tilt.remove_prefix(1);
    if (tilt == "INCLUDE") {
        file.number("the lamp's geometry");
        const std::size_t pairs = file.count("the number of tilt angles", 0);
        file.numbers("tilt angle", pairs);
        file.numbers("tilt factor", pairs);
    } else if (tilt != "NONE") {
        file.fail("TILT={} asks for another file; only NONE and INCLUDE are read", shown(tilt));
    }
    return factor;
}

struct Head {
    double factor = 1.0;  // of all candela values
    std::size_t verticals = 0, horizontals = 0;
};

Head read_head(IesText& file) {
    Head out;
    const bool has_factor = skip_to_numbers(file);
    file.number("the number of lamps");
    file.number("lumens per lamp");
    out.factor = file.positive("the candela multiplier");
    out.verticals = file.count("the number of vertical angles", 2);
    out.horizontals = file.count("the number of horizontal angles", 1);
    const double type = file.number("the photometric type");
    if (type == 2.0 || type == 3.0) {
        file.fail("photometry of type {} is not read, only type C (1): convert the file",
                  type == 2.0 ? 'B' : 'A');
    }
    if (type != 1.0) file.fail("the photometric type is {}, must be 1, 2 or 3", type);
    for (const char* what : {"the units", "the width", "the length", "the height"}) {
        file.number(what);
    }
    out.factor *= file.positive("the ballast factor");
    if (has_factor) {
        out.factor *= file.positive("the ballast-lamp factor");
    } else {
        file.number("the reserved number");
    }
    file.number("the input watts");
    return out;
}

void check_vertical(const IesText& file, const std::vector<double>& angles) {
    const double first = angles.front();
    const double last = angles.back();
    if ((first == 0.0 && (last == 90.0 || last == 180.0)) || (first == 90.0 && last == 180.0))
        return;
    file.fail("vertical angles are from {} to {}, must be 0 to 90, 90 to 180 or 0 to 180", first,
              last);
}

// Candela values at a horizontal angle: those of a column of the file, or between two of them.
struct Column {
    double angle = 0.0;  // [deg]
    std::size_t source = 0, other = 0;
    double part = 0.0;  // of the other one
};

// Adds each column's mirror image across the plane of an angle and its opposite.
void mirror(std::vector<Column>& columns, double plane) {
    const std::size_t count = columns.size();
    for (std::size_t i = 0; i < count; ++i) {
        const double angle = std::fmod(2.0 * plane - columns[i].angle + 720.0, 360.0);
        columns.push_back({angle, columns[i].source, 0, 0.0});
    }
    for (Column& column : columns) column.angle = std::fmod(column.angle, 360.0);
    // Not std::ranges: that of libstdc++ 12 does not compile with clang 14 here.
    std::stable_sort(columns.begin(), columns.end(),
                     [](const Column& a, const Column& b) { return a.angle < b.angle; });
    columns.erase(std::unique(columns.begin(), columns.end(),
                              [](const Column& a, const Column& b) { return a.angle == b.angle; }),
                  columns.end());
}

// Whether angles from 0 leave one gap before 360 that is no wider than the others.
bool lacks_last_angle(const std::vector<double>& angles) {
    double widest = 0.0;
    for (std::size_t i = 1; i < angles.size(); ++i) {
        widest = std::max(widest, angles[i] - angles[i - 1]);
    }
    return angles.front() == 0.0 && angles.back() < 360.0 &&
           360.0 - angles.back() <= widest * (1.0 + 1e-9);
}

// All around, from what symmetry leaves out.
std::vector<Column> unfolded(const IesText& file, const std::vector<double>& angles) {
    std::vector<Column> columns;
    for (const double angle : angles) columns.push_back({angle, columns.size(), 0, 0.0});
    const double first = angles.front();
    const double last = angles.back();
    if (angles.size() == 1) {
        if (first != 0.0) file.fail("the only horizontal angle is {}, must be 0", first);
        return columns;
    }
    if (first == 0.0 && last == 360.0) return columns;
    if (first == 0.0 && last == 90.0) {
        mirror(columns, 90.0);
        mirror(columns, 0.0);
    } else if (first == 0.0 && last == 180.0) {
        mirror(columns, 0.0);
    } else if (first == 90.0 && last == 270.0) {
        mirror(columns, 90.0);
    } else if (!lacks_last_angle(angles)) {
        file.fail(
            "horizontal angles are from {} to {}, must be 0 alone or 0 to 90, 180 or 360, or 90 to "
            "270",
            first, last);
    }
    if (columns.front().angle > 0.0) {
        const double before = 360.0 - columns.back().angle;
        const double part = before / (before + columns.front().angle);
        columns.insert(columns.begin(), {0.0, columns.back().source, columns.front().source, part});
    }
    columns.push_back(columns.front());
    columns.back().angle = 360.0;
    return columns;
}

}  // namespace

PhotometricWeb read_photometric_web(std::string text, const std::string& where) {
    PhotometricWeb web;
    IesText file(text, where);
    const Head head = read_head(file);
    web.vertical = file.angles("vertical angle", head.verticals);
    check_vertical(file, web.vertical);
    const std::vector<double> horizontal = file.angles("horizontal angle", head.horizontals);
    const std::vector<Column> columns = unfolded(file, horizontal);
    std::vector<double> candela = file.numbers("candela value", head.verticals * head.horizontals);
    file.expect_end();
    for (double& value : candela) {
        if (value < 0.0) file.fail("a candela value is {}, must be at least 0", value);
        value *= head.factor;
        web.peak = std::max(web.peak, value);
    }
    if (!(web.peak > 0.0 && web.peak < 1e30)) {
        file.fail("the largest intensity is {} cd, must be greater than 0 and below 1e30",
                  web.peak);
    }
    for (const Column& column : columns) {
        web.horizontal.push_back(column.angle);
        const double* source = &candela[column.source * head.verticals];
        const double* other = &candela[column.other * head.verticals];
        for (std::size_t i = 0; i < head.verticals; ++i) {
            web.candela.push_back(source[i] + column.part * (other[i] - source[i]));
        }
    }
    web.text = std::move(text);
    make_profile_table(web);
    return web;
}

}  // namespace kilolux
