// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/photometry/type_ab.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kilolux {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;  // [rad]

// Of a direction, not of unit length.
struct PoleAxes {
    double up = 0.0, right = 0.0, ahead = 0.0;
};

struct PoleAngles {
    double vertical = 0.0, horizontal = 0.0;  // [deg]
};

PoleAngles angles_of(PoleType pole, const PoleAxes& d) {
    const double length = std::hypot(d.up, d.right, d.ahead);
    const auto about = [&](double aside) { return std::atan2(aside, d.ahead) / kDegree; };
    const auto towards = [&](double along) {
        return std::asin(std::clamp(along / length, -1.0, 1.0)) / kDegree;
    };
    if (pole == PoleType::up) return {towards(d.up), about(d.right)};
    return {about(d.up), towards(d.right)};
}

PoleAxes direction_of(PoleType pole, const PoleAngles& angles) {
    const double v = angles.vertical * kDegree, h = angles.horizontal * kDegree;
    if (pole == PoleType::up)
        return {std::sin(v), std::cos(v) * std::sin(h), std::cos(v) * std::cos(h)};
    return {std::cos(h) * std::sin(v), std::sin(h), std::cos(h) * std::cos(v)};
}

// Adds the mirror image of a grid whose horizontal angles begin at 0.
void mirror_horizontal(PoleGrid& grid) {
    if (grid.horizontal.front() != 0.0) return;
    const std::size_t rows = grid.vertical.size();
    std::vector<double> angles, candela;
    for (std::size_t h = grid.horizontal.size() - 1; h > 0; --h) {
        angles.push_back(-grid.horizontal[h]);
        candela.insert(candela.end(), &grid.candela[h * rows], &grid.candela[h * rows] + rows);
    }
    grid.horizontal.insert(grid.horizontal.begin(), angles.begin(), angles.end());
    grid.candela.insert(grid.candela.begin(), candela.begin(), candela.end());
}

// The same for vertical angles.
void mirror_vertical(PoleGrid& grid) {
    if (grid.vertical.front() != 0.0) return;
    const std::size_t rows = grid.vertical.size();
    std::vector<double> angles, candela;
    for (std::size_t v = rows - 1; v > 0; --v) angles.push_back(-grid.vertical[v]);
    for (std::size_t h = 0; h < grid.horizontal.size(); ++h) {
        for (std::size_t v = rows - 1; v > 0; --v) candela.push_back(grid.candela[h * rows + v]);
        for (std::size_t v = 0; v < rows; ++v) candela.push_back(grid.candela[h * rows + v]);
    }
    grid.vertical.insert(grid.vertical.begin(), angles.begin(), angles.end());
    grid.candela = std::move(candela);
}

// The web's step between vertical angles [deg]: at most half of the grid's finest. Tables of
// kernels have no finer one than the first.
double web_step(double finest) {
    double out = 0.1;
    for (const double wider : {0.2, 0.25, 0.5}) out = wider <= 0.5 * finest ? wider : out;
    return out;
}

double finest_step(const PoleGrid& grid) {
    double least = 180.0;
    for (const auto* angles : {&grid.vertical, &grid.horizontal}) {
        for (std::size_t i = 1; i < angles->size(); ++i) {
            least = std::min(least, (*angles)[i] - (*angles)[i - 1]);
        }
    }
    return least;
}

// Angles from 0 to `last` [deg].
std::vector<double> equal_steps(double last, double step) {
    const int count = static_cast<int>(std::lround(last / step));
    std::vector<double> out;
    for (int i = 0; i <= count; ++i) out.push_back(last * i / count);
    return out;
}

// candela_at() of a grid as if its angles were a web's; no light beyond its horizontal angles.
double grid_value(const PhotometricWeb& grid, const PoleAngles& at) {
    constexpr double kRounding = 1e-9;  // [deg]
    const bool beyond = at.horizontal < grid.horizontal.front() - kRounding ||
                        at.horizontal > grid.horizontal.back() + kRounding;
    const double lowest = grid.vertical.front(), highest = grid.vertical.back();
    if (beyond || at.vertical < lowest - kRounding || at.vertical > highest + kRounding) return 0.0;
    return candela_at(grid, std::clamp(at.vertical, lowest, highest), at.horizontal);
}

// The largest difference of the web from the grid in the grid's directions but its poles [cd].
double largest_difference(const PhotometricWeb& web, const PhotometricWeb& grid, PoleType pole) {
    double most = 0.0;
    const std::size_t rows = grid.vertical.size();
    for (std::size_t h = 0; h < grid.horizontal.size(); ++h) {
        for (std::size_t v = 0; v < rows; ++v) {
            const PoleAngles at{grid.vertical[v], grid.horizontal[h]};
            const double latitude = pole == PoleType::up ? at.vertical : at.horizontal;
            if (std::abs(latitude) == 90.0) continue;
            const PoleAxes d = direction_of(pole, at);
            const double around = std::atan2(d.right, d.up) / kDegree;
            const double down =
                std::min(std::atan2(std::hypot(d.up, d.right), d.ahead) / kDegree, 90.0);
            const double found = candela_at(web, down, around < 0.0 ? around + 360.0 : around);
            most = std::max(most, std::abs(found - grid.candela[h * rows + v]));
        }
    }
    return most;
}

}  // namespace

void set_pole_grid(PhotometricWeb& web, PoleGrid grid) {
    mirror_horizontal(grid);
    mirror_vertical(grid);
    const double finest = finest_step(grid);
    PhotometricWeb measured;
    measured.vertical = std::move(grid.vertical);
    measured.horizontal = std::move(grid.horizontal);
    measured.candela = std::move(grid.candela);
    web.vertical = equal_steps(90.0, web_step(finest));
    web.horizontal = equal_steps(360.0, 0.5);
    for (const double c : web.horizontal) {
        for (const double gamma : web.vertical) {
            const double across = std::sin(gamma * kDegree);
            const PoleAxes d{across * std::cos(c * kDegree), across * std::sin(c * kDegree),
                             gamma == 90.0 ? 0.0 : std::cos(gamma * kDegree)};
            web.candela.push_back(grid_value(measured, angles_of(grid.pole, d)));
        }
    }
    web.peak = *std::max_element(web.candela.begin(), web.candela.end());
    if (!(web.peak > 0.0)) return;
    make_profile_table(web);
    web.table_error =
        std::max(web.table_error, largest_difference(web, measured, grid.pole) / web.peak);
}

}  // namespace kilolux
