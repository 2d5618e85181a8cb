// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/flip_color.h"

#include <cmath>

namespace kilolux {
namespace {

using Matrix = std::array<Color3, 3>;

// Exact fractions of the sRGB primaries' chromaticities and D65 = (0.31271, 0.32902), as FLIP uses.
constexpr Matrix kXyzFromLinear = {{
    {10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
    {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
    {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0},
}};

constexpr double cofactor(const Matrix& m, std::size_t row, std::size_t column) {
    const std::size_t r0 = (row + 1) % 3, r1 = (row + 2) % 3;
    const std::size_t c0 = (column + 1) % 3, c1 = (column + 2) % 3;
    return m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0];
}

constexpr Matrix inverse(const Matrix& m) {
    const double determinant =
        m[0][0] * cofactor(m, 0, 0) + m[0][1] * cofactor(m, 0, 1) + m[0][2] * cofactor(m, 0, 2);
    Matrix out{};
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) {
            out[row][column] = cofactor(m, column, row) / determinant;
        }
    }
    return out;
}

constexpr Matrix kLinearFromXyz = inverse(kXyzFromLinear);

constexpr Color3 multiply(const Matrix& m, const Color3& v) {
    return {m[0][0] * v[0] + m[0][1] * v[1] + m[0][2] * v[2],
            m[1][0] * v[0] + m[1][1] * v[1] + m[1][2] * v[2],
            m[2][0] * v[0] + m[2][1] * v[1] + m[2][2] * v[2]};
}

constexpr Color3 kWhite = multiply(kXyzFromLinear, {1.0, 1.0, 1.0});

// CIE 15:2004, section 8.2.1.1.
double lab_curve(double t) {
    constexpr double kDelta = 6.0 / 29.0;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
}

}  // namespace

Color3 xyz_from_linear(const Color3& rgb) { return multiply(kXyzFromLinear, rgb); }

Color3 linear_from_xyz(const Color3& xyz) { return multiply(kLinearFromXyz, xyz); }

Color3 ycxcz_from_linear(const Color3& rgb) {
    const Color3 xyz = xyz_from_linear(rgb);
    const double x = xyz[0] / kWhite[0];
    const double y = xyz[1] / kWhite[1];
    const double z = xyz[2] / kWhite[2];
    return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

Color3 linear_from_ycxcz(const Color3& ycxcz) {
    const double y = (ycxcz[0] + 16.0) / 116.0;
    const double x = y + ycxcz[1] / 500.0;
    const double z = y - ycxcz[2] / 200.0;
    return linear_from_xyz({x * kWhite[0], y * kWhite[1], z * kWhite[2]});
}

Color3 hunt_lab_from_linear(const Color3& rgb) {
    const Color3 xyz = xyz_from_linear(rgb);
    const double fx = lab_curve(xyz[0] / kWhite[0]);
    const double fy = lab_curve(xyz[1] / kWhite[1]);
    const double fz = lab_curve(xyz[2] / kWhite[2]);
    const double lightness = 116.0 * fy - 16.0;
    const double hunt = 0.01 * lightness;
    return {lightness, hunt * 500.0 * (fx - fy), hunt * 200.0 * (fy - fz)};
}

double hyab_distance(const Color3& a, const Color3& b) {
    const double da = a[1] - b[1];
    const double db = a[2] - b[2];
    return std::abs(a[0] - b[0]) + std::sqrt(da * da + db * db);
}

}  // namespace kilolux
