// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/photometry/photometric_web.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "host/base/error.h"
#include "kernels/shared/light_profile.h"

namespace kilolux {
namespace {

constexpr double kRadian = std::numbers::pi / 180.0;  // [rad/deg]
// The finest steps of a table, 0.1 and 0.5 degrees: 5 MiB where both are needed.
constexpr int kMostRows = 1800;
constexpr int kMostColumns = 720;

// The interval of rising angles that holds `angle`, and where in it.
struct Between {
    std::size_t first = 0;
    double part = 0.0;
};

Between between(const std::vector<double>& angles, double angle) {
    const auto above = std::upper_bound(angles.begin() + 1, angles.end() - 1, angle);
    const auto first = static_cast<std::size_t>(above - angles.begin()) - 1;
    const double part = (angle - angles[first]) / (angles[first + 1] - angles[first]);
    return {first, std::clamp(part, 0.0, 1.0)};
}

// The number of equal steps from the first angle to the last that meet all of them, or `most`.
int steps_of(const std::vector<double>& angles, int most) {
    constexpr double kUnits = 100.0;  // of a degree: files give two decimals
    std::int64_t common = 0;
    for (const double angle : angles) {
        const double units = (angle - angles.front()) * kUnits;
        if (std::abs(units - std::round(units)) > 1e-6) return most;
        common = std::gcd(common, std::llround(units));
    }
    const auto whole = std::llround((angles.back() - angles.front()) * kUnits);
    return static_cast<int>(std::min<std::int64_t>(whole / common, most));
}

double interpolated(double a, double b, double part) { return a + (b - a) * part; }

// The integral of candela times sin over vertical angles up to one [deg], of one horizontal angle.
double ring(const PhotometricWeb& web, std::size_t column, double up_to) {
    double sum = 0.0;
    const std::size_t rows = web.vertical.size();
    for (std::size_t i = 0; i + 1 < rows && web.vertical[i] < up_to; ++i) {
        const double end = std::min(web.vertical[i + 1], up_to);
        const double part = (end - web.vertical[i]) / (web.vertical[i + 1] - web.vertical[i]);
        const double a = web.vertical[i] * kRadian;
        const double b = end * kRadian;
        const double from = web.candela[column * rows + i];
        const double to = interpolated(from, web.candela[column * rows + i + 1], part);
        const double slope = (to - from) / (b - a);
        sum += from * std::cos(a) - to * std::cos(b) + slope * (std::sin(b) - std::sin(a));
    }
    return sum;
}

// The table's value at angles of the file, as a share of the peak.
double table_share(const PhotometricWeb& web, double row, double column) {
    const auto width = static_cast<std::size_t>(web.table[3]) + 1;
    const double last = web.table[2];
    const auto r = static_cast<std::size_t>(std::min(std::floor(row), last - 1.0));
    const auto c = static_cast<std::size_t>(std::floor(column));
    const auto at = [&](std::size_t y, std::size_t x) {
        return double{web.table[PROFILE_HEAD + y * width + std::min(x, width - 1)]};
    };
    const double below = row - static_cast<double>(r);
    const double beside = column - static_cast<double>(c);
    return interpolated(interpolated(at(r, c), at(r, c + 1), beside),
                        interpolated(at(r + 1, c), at(r + 1, c + 1), beside), below);
}

double largest_table_error(const PhotometricWeb& web) {
    double most = 0.0;
    const std::size_t rows = web.vertical.size();
    for (std::size_t h = 0; h < web.horizontal.size(); ++h) {
        for (std::size_t v = 0; v < rows; ++v) {
            const double row = (web.vertical[v] - web.vertical.front()) /
                               (web.vertical.back() - web.vertical.front()) * web.table[2];
            const double column = web.horizontal[h] / 360.0 * web.table[3];
            const double exact = web.candela[h * rows + v] / web.peak;
            most = std::max(most, std::abs(table_share(web, row, column) - exact));
        }
    }
    return most;
}

}  // namespace

double candela_at(const PhotometricWeb& web, double vertical, double horizontal) {
    if (vertical < web.vertical.front() || vertical > web.vertical.back()) return 0.0;
    const std::size_t rows = web.vertical.size();
    const Between v = between(web.vertical, vertical);
    const auto at = [&](std::size_t column) {
        const double* ring = &web.candela[column * rows + v.first];
        return interpolated(ring[0], ring[1], v.part);
    };
    if (web.horizontal.size() == 1) return at(0);
    const Between h = between(web.horizontal, horizontal);
    return interpolated(at(h.first), at(h.first + 1), h.part);
}

double lumens(const PhotometricWeb& web, double up_to) {
    if (web.horizontal.size() == 1) return 2.0 * std::numbers::pi * ring(web, 0, up_to);
    double sum = 0.0;
    for (std::size_t h = 0; h + 1 < web.horizontal.size(); ++h) {
        const double step = (web.horizontal[h + 1] - web.horizontal[h]) * kRadian;
        sum += 0.5 * step * (ring(web, h, up_to) + ring(web, h + 1, up_to));
    }
    return sum;
}

std::string lm63_text(const PhotometricWeb& web) {
    std::string out =
        fmt::format("IESNA:LM-63-2002\nTILT=NONE\n1 {} 1 {} {} 1 2 0 0 0\n1 1 0\n",
                    web.stated_lumens.value_or(-1.0), web.vertical.size(), web.horizontal.size());
    const auto add_lines = [&](const std::vector<double>& values, std::size_t in_line) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            out += fmt::format("{}{}", values[i], (i + 1) % in_line == 0 ? "\n" : " ");
        }
    };
    add_lines(web.vertical, web.vertical.size());
    add_lines(web.horizontal, web.horizontal.size());
    add_lines(web.candela, web.vertical.size());
    return out;
}

void make_profile_table(PhotometricWeb& web) {
    const int rows = steps_of(web.vertical, kMostRows);
    const int columns = web.horizontal.size() == 1 ? 0 : steps_of(web.horizontal, kMostColumns);
    const double first = web.vertical.front();
    const double span = web.vertical.back() - first;
    web.table = {static_cast<float>(first * kRadian), static_cast<float>(rows / (span * kRadian)),
                 static_cast<float>(rows), static_cast<float>(columns)};
    for (int row = 0; row <= rows; ++row) {
        const double vertical = row == rows ? web.vertical.back() : first + span * row / rows;
        for (int column = 0; column <= columns; ++column) {
            const double horizontal = columns == 0 ? 0.0 : 360.0 * column / columns;
            web.table.push_back(
                static_cast<float>(candela_at(web, vertical, horizontal) / web.peak));
        }
    }
    web.table_error = largest_table_error(web);
}

std::vector<float> profile_starts(std::span<const PhotometricWeb> webs) {
    constexpr std::size_t kMost = std::size_t{1} << 24;  // that a float counts exactly
    std::vector<float> starts;
    std::size_t floats = 0;
    for (const PhotometricWeb& web : webs) {
        starts.push_back(static_cast<float>(floats));
        floats += web.table.size();
        if (floats <= kMost) continue;
        throw Error(
            fmt::format("light profiles: the tables of {} IES files hold {} values or more, "
                        "kernels number {}",
                        webs.size(), floats, kMost));
    }
    return starts;
}

}  // namespace kilolux
