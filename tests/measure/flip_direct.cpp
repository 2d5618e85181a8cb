// SPDX-License-Identifier: Apache-2.0
#include "tests/measure/flip_direct.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace kilolux::direct {
namespace {

const double kPi = std::acos(-1.0);

struct Color {
    double v[3];
};

// sRGB's matrix from the chromaticities of its primaries and D65, solved here.
struct Rgb {
    double to_xyz[3][3];
    double white[3];
    Rgb() {
        const double x[3] = {0.64, 0.30, 0.15}, y[3] = {0.33, 0.60, 0.06};
        const double wx = 0.31271 / 0.32902, wz = (1 - 0.31271 - 0.32902) / 0.32902;
        double m[3][4];
        for (int c = 0; c < 3; ++c) {
            m[0][c] = x[c] / y[c];
            m[1][c] = 1.0;
            m[2][c] = (1 - x[c] - y[c]) / y[c];
        }
        m[0][3] = wx, m[1][3] = 1.0, m[2][3] = wz;
        double s[3];
        solve(m, s);
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 3; ++c) {
                const double base[3] = {x[c] / y[c], 1.0, (1 - x[c] - y[c]) / y[c]};
                to_xyz[r][c] = base[r] * s[c];
            }
        }
        white[0] = wx, white[1] = 1.0, white[2] = wz;
    }
    static void solve(double (&m)[3][4], double (&out)[3]) {  // Gauss-Jordan
        for (int p = 0; p < 3; ++p) {
            for (int r = 0; r < 3; ++r) {
                if (r == p) continue;
                const double f = m[r][p] / m[p][p];
                for (int c = 0; c < 4; ++c) m[r][c] -= f * m[p][c];
            }
        }
        for (int p = 0; p < 3; ++p) out[p] = m[p][3] / m[p][p];
    }
};

const Rgb kRgb;

Color xyz_over_white(const Color& rgb) {
    Color out{};
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) out.v[r] += kRgb.to_xyz[r][c] * rgb.v[c] / kRgb.white[r];
    }
    return out;
}

Color opponent(const Color& rgb) {
    const Color t = xyz_over_white(rgb);
    return {{116 * t.v[1] - 16, 500 * (t.v[0] - t.v[1]), 200 * (t.v[1] - t.v[2])}};
}

Color rgb_of_opponent(const Color& o) {
    const double y = (o.v[0] + 16) / 116;
    const double t[3] = {y + o.v[1] / 500, y, y - o.v[2] / 200};
    double m[3][4];
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) m[r][c] = kRgb.to_xyz[r][c];
        m[r][3] = t[r] * kRgb.white[r];
    }
    Color out{};
    Rgb::solve(m, out.v);
    for (double& v : out.v) v = std::clamp(v, 0.0, 1.0);
    return out;
}

Color hunt_lab(const Color& rgb) {
    const Color t = xyz_over_white(rgb);
    double f[3];
    for (int i = 0; i < 3; ++i) {
        f[i] = t.v[i] > 216.0 / 24389.0 ? std::pow(t.v[i], 1.0 / 3.0)
                                        : (24389.0 / 27.0 * t.v[i] + 16.0) / 116.0;
    }
    const double lightness = 116 * f[1] - 16;
    return {
        {lightness, lightness / 100 * 500 * (f[0] - f[1]), lightness / 100 * 200 * (f[1] - f[2])}};
}

double hyab(const Color& a, const Color& b) {
    const double da = a.v[1] - b.v[1], db = a.v[2] - b.v[2];
    return std::abs(a.v[0] - b.v[0]) + std::sqrt(da * da + db * db);
}

double remap(double distance) {
    const double largest = std::pow(hyab(hunt_lab({{0, 1, 0}}), hunt_lab({{0, 0, 1}})), 0.7);
    const double e = std::pow(distance, 0.7);
    if (e < 0.4 * largest) return 0.95 / (0.4 * largest) * e;
    return 0.95 + (e - 0.4 * largest) / (0.6 * largest) * 0.05;
}

struct Picture {
    int width, height;
    std::vector<Color> pixels;
    const Color& at(int x, int y) const {
        const int cx = std::clamp(x, 0, width - 1), cy = std::clamp(y, 0, height - 1);
        return pixels[static_cast<std::size_t>(cy * width + cx)];
    }
};

using Weight = std::function<double(int, int)>;

// sum of w * channel over the window, over the sum of w.
double blur(const Picture& p, int x, int y, int radius, int channel, const Weight& w) {
    double sum = 0, total = 0;
    for (int j = -radius; j <= radius; ++j) {
        for (int i = -radius; i <= radius; ++i) {
            sum += w(i, j) * p.at(x + i, y + j).v[channel];
            total += w(i, j);
        }
    }
    return sum / total;
}

// The window's positive weights scaled to sum 1, its negative ones to -1, on (Y + 16) / 116.
double feature(const Picture& p, int x, int y, int radius, const Weight& w) {
    double plus = 0, minus = 0, plus_total = 0, minus_total = 0;
    for (int j = -radius; j <= radius; ++j) {
        for (int i = -radius; i <= radius; ++i) {
            const double weight = w(i, j);
            const double value = (p.at(x + i, y + j).v[0] + 16) / 116;
            (weight > 0 ? plus : minus) += weight * value;
            (weight > 0 ? plus_total : minus_total) += std::abs(weight);
        }
    }
    return plus / plus_total + minus / minus_total;
}

Color seen_color(const Picture& p, int x, int y, double ppd) {
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * ppd));
    const auto term = [&](double a, double b, int i, int j) {
        const double x2 = (i * i + j * j) / (ppd * ppd);
        return a * std::sqrt(kPi / b) * std::exp(-kPi * kPi * x2 / b);
    };
    const Weight achromatic = [&](int i, int j) { return term(1, 0.0047, i, j); };
    const Weight red_green = [&](int i, int j) { return term(1, 0.0053, i, j); };
    const Weight blue_yellow = [&](int i, int j) {
        return term(34.1, 0.04, i, j) + term(13.5, 0.025, i, j);
    };
    const Color blurred = {{blur(p, x, y, radius, 0, achromatic),
                            blur(p, x, y, radius, 1, red_green),
                            blur(p, x, y, radius, 2, blue_yellow)}};
    return hunt_lab(rgb_of_opponent(blurred));
}

struct Features {
    double edge, point;
};

Features features(const Picture& p, int x, int y, double ppd) {
    const double sigma = 0.5 * 0.082 * ppd;
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    const auto g = [&](int i, int j) { return std::exp(-(i * i + j * j) / (2 * sigma * sigma)); };
    const auto second = [&](int i) { return i * i / (sigma * sigma) - 1; };
    const double ex = feature(p, x, y, radius, [&](int i, int j) { return -i * g(i, j); });
    const double ey = feature(p, x, y, radius, [&](int i, int j) { return -j * g(i, j); });
    const double px = feature(p, x, y, radius, [&](int i, int j) { return second(i) * g(i, j); });
    const double py = feature(p, x, y, radius, [&](int i, int j) { return second(j) * g(i, j); });
    return {std::hypot(ex, ey), std::hypot(px, py)};
}

Picture opponent_picture(const std::vector<double>& rgb, int width, int height) {
    Picture out{width, height, {}};
    for (std::size_t i = 0; i < rgb.size(); i += 3) {
        out.pixels.push_back(opponent({{rgb[i], rgb[i + 1], rgb[i + 2]}}));
    }
    return out;
}

}  // namespace

std::vector<double> flip(const std::vector<double>& a, const std::vector<double>& b, int width,
                         int height, double pixels_per_degree) {
    const Picture pa = opponent_picture(a, width, height);
    const Picture pb = opponent_picture(b, width, height);
    std::vector<double> out;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double color = remap(hyab(seen_color(pa, x, y, pixels_per_degree),
                                            seen_color(pb, x, y, pixels_per_degree)));
            const Features fa = features(pa, x, y, pixels_per_degree);
            const Features fb = features(pb, x, y, pixels_per_degree);
            const double difference =
                std::max(std::abs(fa.edge - fb.edge), std::abs(fa.point - fb.point));
            out.push_back(std::pow(color, 1 - std::sqrt(difference / std::sqrt(2.0))));
        }
    }
    return out;
}

double uniform_flip(const double (&a)[3], const double (&b)[3]) {
    return remap(hyab(hunt_lab({{a[0], a[1], a[2]}}), hunt_lab({{b[0], b[1], b[2]}})));
}

}  // namespace kilolux::direct
