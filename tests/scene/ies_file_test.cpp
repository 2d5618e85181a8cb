// SPDX-License-Identifier: Apache-2.0
// IES files: their contents, and the error for each kind of bad file.
#include <gtest/gtest.h>
#include <numbers>

#include "host/base/error.h"
#include "host/scene/lights/photometry/photometric_web.h"
#include "host/scene/lights/photometry/photometry_file.h"
#include "tests/support/ies_text.h"

namespace kilolux {
namespace {

PhotometricWeb web_of(const IesText& ies) { return read_photometric_web(ies_text(ies), "x.ies"); }

std::string refusal(const std::string& text) {
    try {
        read_photometric_web(text, "x.ies");
    } catch (const Error& error) {
        return error.what();
    }
    return "none";
}

void expect_refused(const IesText& ies, const std::string& why) {
    const std::string message = refusal(ies_text(ies));
    EXPECT_TRUE(message.starts_with("x.ies: line ")) << message;
    EXPECT_NE(message.find(why), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

double by_angles(double vertical, double horizontal) { return 1.0 + vertical + 3.0 * horizontal; }

TEST(IesFile, IsReadAsItStands) {
    IesText ies{.horizontal = {0, 90, 180, 270, 360}, .candela = by_angles};
    ies.multiplier = 2.0;
    ies.ballast = 0.5;
    ies.second_ballast = 7.0;  // reserved since LM-63-1995
    const PhotometricWeb web = web_of(ies);
    EXPECT_EQ(web.horizontal, ies.horizontal);
    EXPECT_EQ(web.vertical, ies.vertical);
    EXPECT_DOUBLE_EQ(web.peak, by_angles(90, 360));
    EXPECT_DOUBLE_EQ(candela_at(web, 45, 90), by_angles(45, 90));
    EXPECT_DOUBLE_EQ(candela_at(web, 10, 20), by_angles(10, 20));  // it is linear
    EXPECT_EQ(candela_at(web, 90.001, 0), 0.0);
    EXPECT_LE(web.table_error, 6e-8);  // a float's rounding
}

TEST(IesFile, OldEditionsHaveASecondBallastFactor) {
    IesText ies;
    ies.second_ballast = 3.0;
    for (const char* first : {"IESNA91\n", "[LUMCAT] 17\n", ""}) {
        ies.head = std::string(first) + "TILT=NONE\n";
        EXPECT_DOUBLE_EQ(web_of(ies).peak, 300.0) << first;
    }
    for (const char* first : {"IESNA:LM-63-1995\n", "IESNA:LM-63-2002\n", "IES:LM-63-2019\r\n"}) {
        ies.head = std::string(first) + "TILT=NONE\r\n";
        EXPECT_DOUBLE_EQ(web_of(ies).peak, 100.0) << first;
    }
}

TEST(IesFile, TiltFactorsAreSkippedAndCommasAreGaps) {
    IesText ies;
    ies.head = "IESNA91\nTILT=INCLUDE\n1\n3\n0 45 90\n1 .9 .8\n";
    std::string text = ies_text(ies);
    EXPECT_DOUBLE_EQ(read_photometric_web(text, "").peak, 100.0);
    const std::size_t numbers = text.find("1 -1 ");
    for (std::size_t i = numbers; i < text.size(); ++i) {
        if (text[i] == ' ') text[i] = ',';
    }
    text += "\x1a";  // DOS ends files with it
    EXPECT_DOUBLE_EQ(read_photometric_web(text, "").peak, 100.0);
}

// A quarter, a half and the other two halves unfold to the whole file.
TEST(IesFile, SymmetriesAreUnfolded) {
    const auto quarter = [](double v, double h) {
        return 50.0 + v + 10.0 * std::cos(2.0 * h * std::numbers::pi / 180.0);
    };
    const auto half = [](double v, double h) {
        return 50.0 + v + 10.0 * std::cos(h * std::numbers::pi / 180.0);
    };
    const auto side = [](double v, double h) {
        return 50.0 + v + 10.0 * std::sin(h * std::numbers::pi / 180.0);
    };
    const struct {
        std::function<double(double, double)> candela;
        std::vector<double> angles;
    } cases[] = {{quarter, angle_steps(0, 90, 4)},
                 {half, angle_steps(0, 180, 8)},
                 {side, angle_steps(90, 270, 8)},
                 {half, angle_steps(0, 337.5, 15)}};
    for (const auto& c : cases) {
        const PhotometricWeb whole =
            web_of({.horizontal = angle_steps(0, 360, 16), .candela = c.candela});
        const PhotometricWeb web = web_of({.horizontal = c.angles, .candela = c.candela});
        ASSERT_EQ(web.horizontal, whole.horizontal);
        for (std::size_t i = 0; i < whole.candela.size(); ++i) {
            ASSERT_NEAR(web.candela[i], whole.candela[i], 1e-10) << c.angles.back() << ' ' << i;
        }
    }
}

// The file has no angle at 0: the values on both sides meet there.
TEST(IesFile, AHalfFrom90To270MeetsAtZero) {
    const PhotometricWeb web = web_of({.horizontal = {90, 150, 210, 270}, .candela = by_angles});
    EXPECT_EQ(web.horizontal, (std::vector<double>{0, 30, 90, 150, 210, 270, 330, 360}));
    EXPECT_DOUBLE_EQ(candela_at(web, 45, 30), by_angles(45, 150));
    EXPECT_DOUBLE_EQ(candela_at(web, 45, 330), by_angles(45, 210));
    EXPECT_DOUBLE_EQ(candela_at(web, 45, 0), by_angles(45, 180));
}

// The table of a file whose angles have no common step states its error.
TEST(IesFile, TablesHaveTheFilesSteps) {
    const PhotometricWeb web =
        web_of({.vertical = {0, 2.5, 5, 15, 90}, .horizontal = {0, 22.5, 90}});
    EXPECT_EQ(web.table[2], 36.0f);
    EXPECT_EQ(web.table[3], 16.0f);
    EXPECT_EQ(web.table.size(), 4u + 37u * 17u);
    EXPECT_LE(web.table_error, 1e-7);
    IesText fine{.vertical = {0, 1.0 / 3.0, 0.34, 90}};
    fine.candela = [](double v, double) { return v == 0.34 ? 100.0 : 0.0; };
    const PhotometricWeb lossy = web_of(fine);
    EXPECT_EQ(lossy.table.size(), 4u + 1801u);
    EXPECT_GT(lossy.table_error, 0.5);
}

// The integral of the web is the flux of the file's lamp.
TEST(IesFile, TheSphereHasTheLumensOfTheWeb) {
    constexpr double kPi = std::numbers::pi;
    const auto even = [](double, double) { return 100.0; };
    const IesText sphere{.vertical = {0, 90, 180}, .candela = even};
    EXPECT_NEAR(lumens(web_of(sphere)), 400.0 * kPi, 1e-9);
    EXPECT_NEAR(lumens(web_of({.candela = even})), 200.0 * kPi, 1e-9);
    // A Lambertian lamp of 1000 lm, within the error of linear steps of a degree.
    IesText lambert{.vertical = angle_steps(0, 90, 90), .horizontal = {0, 45, 90}};
    lambert.candela = [](double v, double) { return 1000.0 / kPi * std::cos(v * kPi / 180.0); };
    EXPECT_NEAR(lumens(web_of(lambert)), 1000.0, 0.1);
    // An uneven one, against sums over small cells.
    const PhotometricWeb web = web_of(uneven_ies());
    double sum = 0.0;
    const double step = kPi / 180.0;
    for (int v = 0; v < 180; ++v) {
        for (int h = 0; h < 360; ++h) {
            const double ring = std::cos(v * step) - std::cos((v + 1) * step);
            sum += candela_at(web, v + 0.5, h + 0.5) * ring * step;
        }
    }
    EXPECT_NEAR(sum / lumens(web), 1.0, 1e-4);
}

// A beam by the parts of its unit direction: 2 as wide to the right as upwards, and lopsided.
double beam(double up, double right, double ahead) {
    return 100.0 * std::exp(-8.0 * up * up - 2.0 * right * right) * (1.0 + 0.3 * up - 0.2 * right) *
           std::max(ahead, 0.0);
}

// The beam as a grid of type A or B, by the relations of the systems (CIE 121): with gamma from the
// light's direction and C from up to the right, tan B = cos C tan gamma and sin beta = sin C sin
// gamma, where B is vertical and beta horizontal; type A has both swapped.
IesText pole_beam(int type, double first, double step) {
    IesText ies;
    ies.type = type;
    ies.vertical = ies.horizontal =
        angle_steps(first, 90, static_cast<int>(std::lround((90.0 - first) / step)));
    ies.candela = [type](double v, double h) {
        const double r = std::numbers::pi / 180.0;
        if (type == 2) {
            return beam(std::cos(h * r) * std::sin(v * r), std::sin(h * r),
                        std::cos(h * r) * std::cos(v * r));
        }
        return beam(std::sin(v * r), std::cos(v * r) * std::sin(h * r),
                    std::cos(v * r) * std::cos(h * r));
    };
    return ies;
}

TEST(IesFile, TypesAAndBAreAimedAtVerticalAngle0) {
    for (const int type : {2, 3}) {
        const PhotometricWeb web = web_of(pole_beam(type, -90, 2.5));
        EXPECT_EQ(web.vertical.back(), 90.0);
        EXPECT_EQ(web.horizontal.back(), 360.0);
        EXPECT_NEAR(candela_at(web, 0, 123), 100.0, 1e-9);
        double largest = 0.0;
        for (double gamma = 0.0; gamma <= 90.0; gamma += 3.1) {
            for (double c = 0.0; c < 360.0; c += 7.3) {
                const double r = std::numbers::pi / 180.0;
                const double exact =
                    beam(std::sin(gamma * r) * std::cos(c * r),
                         std::sin(gamma * r) * std::sin(c * r), std::cos(gamma * r));
                largest = std::max(largest, std::abs(candela_at(web, gamma, c) - exact));
            }
        }
        EXPECT_LE(largest, 0.5) << type;  // bilinear in steps of 2.5 degrees
        // The grid's slope changes at its angles by the beam's curvature, 16 / rad^2, times 2.5
        // degrees; steps of half a degree miss a quarter of a degree of that at most: 1.5e-3.
        EXPECT_LE(web.table_error, 2e-3) << type;
        EXPECT_GT(web.table_error, 0.0) << type;
    }
}

// A cosine emitter of 1000 lm, which types A and B need not know of.
TEST(IesFile, TypesAAndBHaveTheFlux) {
    for (const int type : {2, 3}) {
        IesText ies = pole_beam(type, 0, 1.0);
        ies.candela = [](double v, double h) {
            const double r = std::numbers::pi / 180.0;
            return 1000.0 / std::numbers::pi * std::cos(v * r) * std::cos(h * r);
        };
        EXPECT_NEAR(lumens(web_of(ies)), 1000.0, 0.3) << type;
    }
}

// A grid that starts at 0 is the whole one of a symmetric beam; beyond a narrow one it is dark.
TEST(IesFile, TypesAAndBAreMirroredAndMayBeNarrow) {
    const auto even = [](double v, double h) { return 200.0 - std::abs(v) - 0.5 * std::abs(h); };
    for (const int type : {2, 3}) {
        IesText whole{.vertical = angle_steps(-90, 90, 36), .horizontal = angle_steps(-90, 90, 36)};
        whole.candela = even;
        whole.type = type;
        IesText part = whole;
        part.vertical = part.horizontal = angle_steps(0, 90, 18);
        EXPECT_EQ(web_of(part).candela, web_of(whole).candela);
        IesText narrow = whole;
        narrow.vertical = narrow.horizontal = angle_steps(-10, 10, 4);
        const PhotometricWeb web = web_of(narrow);
        EXPECT_NEAR(candela_at(web, 9, 0), 191.0, 1.0);
        EXPECT_NEAR(candela_at(web, 9, 90), 195.5, 1.0);
        EXPECT_EQ(candela_at(web, 20, 45), 0.0);
    }
}

// Lamps times their lumens times the ballast's factors; -1 says that there are none.
TEST(IesFile, LumensOfTheLampsAreStated) {
    std::string text = ies_text({});
    EXPECT_FALSE(read_photometric_web(text, "").stated_lumens.has_value());
    text.replace(text.find("1 -1 "), 5, "2 600 ");
    text.replace(text.find("1 1 35"), 6, "0.9 1 35");
    EXPECT_DOUBLE_EQ(read_photometric_web(text, "").stated_lumens.value(), 1080.0);
}

TEST(IesFile, AByteOrderMarkIsLeftOut) {
    // By its first line this edition has no second ballast factor.
    const std::string text = ies_text({.second_ballast = 2});
    const PhotometricWeb web = read_photometric_web("\xef\xbb\xbf" + text, "");
    EXPECT_EQ(web.text, text);
    EXPECT_DOUBLE_EQ(web.peak, 100.0);
}

TEST(IesFile, WhatCannotBeUsedIsRefusedInALine) {
    EXPECT_EQ(
        refusal(""),
        "x.ies: line 1: there is no line TILT=, so this is no IES file (LM-63); nor are lines 2 "
        "and 3 numbers, so it is no EULUMDAT file");
    EXPECT_NE(refusal("TILT=lamp.tlt\n").find("TILT=lamp.tlt asks for another file"),
              std::string::npos);
    expect_refused({.type = 2}, "horizontal angles are from 0 to 0, must be two or more");
    expect_refused({.vertical = {5, 90}, .horizontal = {-90, 90}, .type = 3},
                   "vertical angles are from 5 to 90, must be two or more from 0 or below");
    expect_refused({.vertical = {-90, 90}, .horizontal = {-90, 100}, .type = 2},
                   "horizontal angles are from -90 to 100");
    expect_refused({.type = 4}, "photometric type is 4");
    expect_refused({.vertical = {0, 45, 85}}, "vertical angles are from 0 to 85");
    expect_refused({.vertical = {0, 90, 45}}, "vertical angles must rise, 45 follows 90");
    expect_refused({.vertical = {0}}, "number of vertical angles is 1");
    expect_refused({.horizontal = {45}}, "the only horizontal angle is 45");
    expect_refused({.horizontal = {0, 45}}, "horizontal angles are from 0 to 45");
    expect_refused({.horizontal = {90, 270, 300}}, "horizontal angles are from 90 to 300");
    expect_refused({.candela = [](double, double) { return 0.0; }}, "largest intensity is 0 cd");
    expect_refused({.candela = [](double v, double) { return v - 1; }}, "a candela value is -1");
    expect_refused({.candela = [](double, double) { return 1e300; }},
                   "largest intensity is 1e+300");
    expect_refused({.multiplier = -1}, "candela multiplier is -1, must be greater than 0");
    expect_refused({.ballast = 0}, "ballast factor is 0");
    expect_refused({.head = "IESNA91\nTILT=NONE\n", .second_ballast = -2}, "ballast-lamp factor");
}

TEST(IesFile, BrokenNumbersAreShownWithTheirLine) {
    const std::string text = ies_text({});
    for (std::size_t cut = text.find("1 -1"); cut + 3 < text.size(); ++cut) {
        const std::string message = refusal(text.substr(0, cut));
        ASSERT_NE(message, "none") << cut;
        ASSERT_TRUE(message.starts_with("x.ies: line ")) << message;
    }
    EXPECT_NE(refusal(text + "17").find("'17' follows the last candela value"), std::string::npos);
    std::string spoilt = text;
    spoilt.replace(spoilt.find("100"), 3, "1o0");
    EXPECT_EQ(refusal(spoilt), "x.ies: line 8: a candela value is '1o0', must be a number");
    spoilt = text;
    spoilt.replace(spoilt.find(" 3 1 1 "), 7, " 99999 99999 1 ");
    EXPECT_NE(refusal(spoilt).find("99999 vertical angles are more than the"), std::string::npos)
        << refusal(spoilt);
    spoilt.replace(spoilt.find("99999"), 5, "2.5");
    EXPECT_NE(refusal(spoilt).find("is 2.5, must be a whole number"), std::string::npos);
}

}  // namespace
}  // namespace kilolux
