// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

namespace kilolux {

/// The contents of a EULUMDAT file, for tests that write one.
struct LdtText {
    int symmetry = 0;
    std::vector<double> c{0, 90, 180, 270};            // [deg], of the whole circle
    std::vector<double> gamma{0, 45, 90};              // [deg]
    std::function<double(double, double)> intensity =  // of gamma and C [cd / 1000 lm]
        [](double g, double) { return 100.0 - g; };
    double lumens = 2000.0, conversion = 1.0;
    double down_percent = 100.0, output_percent = 80.0;
    int lamps = 1, sets = 1;
    std::string name = "lamp";
};

/// The planes that the symmetry stores, in the file's order [deg].
inline std::vector<double> stored_planes(const LdtText& ldt) {
    const auto all = ldt.c.size();
    const std::size_t first = ldt.symmetry == 3 ? 3 * all / 4 : 0;
    const std::size_t counts[] = {all, 1, all / 2 + 1, all / 2 + 1, all / 4 + 1};
    std::vector<double> out;
    for (std::size_t i = 0; i < counts[ldt.symmetry]; ++i) {
        out.push_back(ldt.c[(first + i) % all]);
    }
    return out;
}

/// A line a field, with line feeds and decimal points.
inline std::string ldt_text(const LdtText& ldt) {
    std::ostringstream out;
    out.precision(17);
    out << "Maker\n3\n" << ldt.symmetry << '\n' << ldt.c.size() << "\n0\n" << ldt.gamma.size();
    out << "\n0\nreport\n" << ldt.name << "\n17\nlamp.ldt\n2024\n100\n50\n30\n80\n40\n0\n0\n0\n0\n";
    out << ldt.down_percent << '\n' << ldt.output_percent << '\n' << ldt.conversion << "\n0\n";
    out << ldt.sets << '\n';
    for (int set = 0; set < ldt.sets; ++set) {
        out << ldt.lamps << "\nLED\n" << ldt.lumens * (set + 1) << "\n3000K\n80\n35\n";
    }
    for (int ratio = 0; ratio < 10; ++ratio) out << "0.5\n";
    for (const double c : ldt.c) out << c << '\n';
    for (const double gamma : ldt.gamma) out << gamma << '\n';
    for (const double c : stored_planes(ldt)) {
        for (const double gamma : ldt.gamma) out << ldt.intensity(gamma, c) << '\n';
    }
    return out.str();
}

/// As European programs write them: decimal commas, CRLF, Latin-1, end of file of DOS.
inline std::string european(std::string text) {
    std::string out;
    for (const char c : text) {
        if (c == '\n') out += '\r';
        out += c == '.' ? ',' : c;
    }
    const std::size_t name = out.find("lamp");
    if (name != std::string::npos)
        out.replace(name, 4,
                    "Stra\xdf"
                    "enleuchte");
    return out + "\r\n\x1a";
}

}  // namespace kilolux
