// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace kilolux {

/// The contents of an IES file, for tests that write one.
struct IesText {
    std::string head = "IESNA:LM-63-2002\n[TEST] generated\nTILT=NONE\n";
    std::vector<double> vertical{0, 45, 90};
    std::vector<double> horizontal{0};
    std::function<double(double, double)> candela =  // of vertical and horizontal [cd]
        [](double v, double) { return 100.0 - v; };
    double multiplier = 1.0, ballast = 1.0, second_ballast = 1.0;
    int type = 1;
};

inline std::string ies_text(const IesText& ies) {
    std::ostringstream out;
    out.precision(17);
    out << ies.head << "1 -1 " << ies.multiplier << ' ' << ies.vertical.size() << ' '
        << ies.horizontal.size() << ' ' << ies.type << " 2 0.1 0.1 0\n"
        << ies.ballast << ' ' << ies.second_ballast << " 35\n";
    for (const auto* angles : {&ies.vertical, &ies.horizontal}) {
        for (const double angle : *angles) out << angle << ' ';
        out << '\n';
    }
    for (const double horizontal : ies.horizontal) {
        for (const double vertical : ies.vertical) out << ies.candela(vertical, horizontal) << ' ';
        out << '\n';
    }
    return out.str();
}

/// Angles from `first` to `last` in equal steps [deg].
inline std::vector<double> angle_steps(double first, double last, int steps) {
    std::vector<double> out;
    for (int i = 0; i <= steps; ++i) out.push_back(first + (last - first) * i / steps);
    return out;
}

/// A wall washer's web, which differs all around and upwards.
inline IesText uneven_ies() {
    IesText ies;
    ies.vertical = angle_steps(0, 180, 36);
    ies.horizontal = angle_steps(0, 360, 24);
    ies.candela = [](double vertical, double horizontal) {
        const double v = vertical * std::numbers::pi / 180.0;
        const double h = horizontal * std::numbers::pi / 180.0;
        return 900.0 * std::pow(std::cos(0.5 * v), 6) * (1.3 + std::cos(h + v)) +
               40.0 * (1.0 + std::sin(2.0 * h)) * std::sin(v);
    };
    return ies;
}

}  // namespace kilolux
