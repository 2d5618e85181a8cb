// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/ssim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace kilolux {
namespace {

using Codes = std::vector<std::uint8_t>;

Codes noisy_codes(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    Codes out(static_cast<std::size_t>(4 * width * height));
    for (auto& c : out) c = static_cast<std::uint8_t>(random() >> 24);
    return out;
}

Codes gray(int width, int height, std::uint8_t code) {
    return Codes(static_cast<std::size_t>(4 * width * height), code);
}

double luma(const Codes& c, int i) {
    const auto at = [&](int k) { return c[static_cast<std::size_t>(4 * i + k)]; };
    return 0.2126 * at(0) + 0.7152 * at(1) + 0.0722 * at(2);
}

// Equation 13 of the paper with its sums written out, two-dimensional, central moments.
double direct_ssim(const Codes& a, const Codes& b, int width, int height) {
    const double c1 = 6.5025, c2 = 58.5225;
    double total = 0.0;
    int windows = 0;
    for (int y = 5; y < height - 5; ++y) {
        for (int x = 5; x < width - 5; ++x, ++windows) {
            double w = 0, ma = 0, mb = 0, va = 0, vb = 0, cov = 0;
            for (int pass = 0; pass < 2; ++pass) {
                for (int j = -5; j <= 5; ++j) {
                    for (int i = -5; i <= 5; ++i) {
                        const double g = std::exp(-(i * i + j * j) / 4.5);
                        const double la = luma(a, (y + j) * width + x + i);
                        const double lb = luma(b, (y + j) * width + x + i);
                        if (pass == 0) {
                            w += g, ma += g * la, mb += g * lb;
                            continue;
                        }
                        va += g / w * (la - ma) * (la - ma);
                        vb += g / w * (lb - mb) * (lb - mb);
                        cov += g / w * (la - ma) * (lb - mb);
                    }
                }
                if (pass == 0) ma /= w, mb /= w;
            }
            total +=
                (2 * ma * mb + c1) * (2 * cov + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
        }
    }
    return total / windows;
}

TEST(Ssim, MatchesTheFormulaWrittenOut) {
    const Codes a = noisy_codes(23, 17, 1);
    Codes b = a;
    for (std::size_t i = 0; i < b.size(); i += 7) b[i] = static_cast<std::uint8_t>(b[i] / 2);
    const auto value = ssim({23, 17, a}, {23, 17, b});
    ASSERT_TRUE(value);
    EXPECT_NEAR(*value, direct_ssim(a, b, 23, 17), 1e-10);
    EXPECT_LT(*value, 0.99);
}

TEST(Ssim, EqualPicturesGiveOne) {
    const Codes a = noisy_codes(30, 20, 2);
    EXPECT_NEAR(ssim({30, 20, a}, {30, 20, a}).value(), 1.0, 1e-12);
}

TEST(Ssim, FlatPicturesDifferByLuminanceOnly) {
    const Codes a = gray(16, 16, 100), b = gray(16, 16, 150);
    const double c1 = 6.5025;
    EXPECT_NEAR(ssim({16, 16, a}, {16, 16, b}).value(),
                (2.0 * 100 * 150 + c1) / (100.0 * 100 + 150.0 * 150 + c1), 1e-9);
}

TEST(Ssim, IsSymmetricAndFallsWithNoise) {
    const Codes a = noisy_codes(40, 40, 3);
    double last = 1.0;
    for (const int strength : {8, 32, 128}) {
        Codes b = a;
        std::mt19937 random(4);
        for (auto& c : b) {
            const int offset = static_cast<int>(random() % static_cast<unsigned>(strength));
            c = static_cast<std::uint8_t>(std::min(255, c + offset));
        }
        const double value = ssim({40, 40, a}, {40, 40, b}).value();
        EXPECT_LT(value, last) << strength;
        EXPECT_NEAR(value, ssim({40, 40, b}, {40, 40, a}).value(), 1e-12);
        last = value;
    }
}

TEST(Ssim, IsUndefinedBelowTheWindow) {
    const Codes a = gray(10, 40, 1);
    EXPECT_FALSE(ssim({10, 40, a}, {10, 40, a}));
    const Codes b = gray(11, 11, 1);
    EXPECT_TRUE(ssim({11, 11, b}, {11, 11, b}));
}

}  // namespace
}  // namespace kilolux
