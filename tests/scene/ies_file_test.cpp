// SPDX-License-Identifier: Apache-2.0
// IES files: their contents, and the error for each kind of bad file.
#include <gtest/gtest.h>
#include <numbers>

#include "host/base/error.h"
#include "host/scene/lights/ies_file.h"
#include "host/scene/lights/photometric_web.h"
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

TEST(IesFile, WhatCannotBeUsedIsRefusedInALine) {
    EXPECT_EQ(refusal(""), "x.ies: line 1: there is no line TILT=, so this is no IES file (LM-63)");
    EXPECT_NE(refusal("TILT=lamp.tlt\n").find("TILT=lamp.tlt asks for another file"),
              std::string::npos);
    expect_refused({.type = 2}, "photometry of type B is not read, only type C (1): convert");
    expect_refused({.type = 3}, "photometry of type A");
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
