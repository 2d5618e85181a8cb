// SPDX-License-Identifier: Apache-2.0
// EULUMDAT files: their contents, symmetries, and the error for each kind of bad file.
#include <gtest/gtest.h>

#include <numbers>

#include "host/base/error.h"
#include "host/scene/lights/photometry/photometry_file.h"
#include "tests/support/ies_text.h"
#include "tests/support/ldt_text.h"

namespace kilolux {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

PhotometricWeb ldt_web(const LdtText& ldt) { return read_photometric_web(ldt_text(ldt), "x.ldt"); }

std::string ldt_refusal(const std::string& text) {
    try {
        read_photometric_web(text, "x.ldt");
    } catch (const Error& error) {
        return error.what();
    }
    return "none";
}

void expect_ldt_refused(const LdtText& ldt, const std::string& why) {
    const std::string message = ldt_refusal(ldt_text(ldt));
    EXPECT_TRUE(message.starts_with("x.ldt: line ")) << message;
    EXPECT_NE(message.find(why), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

double by_gamma_and_c(double gamma, double c) { return 1.0 + gamma + 3.0 * c; }

// Candela are the file's values times the flux of the first lamp set in thousand lumens and the
// conversion factor.
TEST(LdtFile, CandelaAreOfTheLampsFlux) {
    LdtText ldt{.intensity = by_gamma_and_c, .lumens = 2500.0, .conversion = 0.5};
    ldt.sets = 2;
    ldt.down_percent = 95.0;
    const PhotometricWeb web = ldt_web(ldt);
    EXPECT_EQ(web.vertical, ldt.gamma);
    EXPECT_EQ(web.horizontal, (std::vector<double>{0, 90, 180, 270, 360}));
    EXPECT_DOUBLE_EQ(candela_at(web, 45, 180), 1.25 * by_gamma_and_c(45, 180));
    EXPECT_DOUBLE_EQ(candela_at(web, 45, 360), 1.25 * by_gamma_and_c(45, 0));
    EXPECT_DOUBLE_EQ(web.peak, 1.25 * by_gamma_and_c(90, 270));
    EXPECT_DOUBLE_EQ(web.stated_lumens.value(), 2000.0);
    EXPECT_DOUBLE_EQ(web.stated_down_share.value(), 0.95);
}

TEST(LdtFile, CommasCarriageReturnsAndLatin1AreRead) {
    LdtText ldt{.intensity = [](double gamma, double c) { return 0.25 + gamma + c; }};
    ldt.conversion = 1.5;
    const PhotometricWeb plain = ldt_web(ldt);
    const PhotometricWeb web = read_photometric_web(european(ldt_text(ldt)), "x.ldt");
    EXPECT_EQ(web.candela, plain.candela);
    EXPECT_EQ(web.horizontal, plain.horizontal);
}

// Each symmetry unfolds to the file that stores all planes; 3 begins at C270.
TEST(LdtFile, SymmetriesAreUnfolded) {
    const auto about_c0 = [](double g, double c) { return 50 + g + 10 * std::cos(c * kDegree); };
    const auto about_c90 = [](double g, double c) { return 50 + g + 10 * std::sin(c * kDegree); };
    const auto both = [](double g, double c) { return 50 + g + 10 * std::cos(2 * c * kDegree); };
    const auto around = [](double g, double) { return 50 + g; };
    const std::function<double(double, double)> by_symmetry[] = {by_gamma_and_c, around, about_c0,
                                                                 about_c90, both};
    for (int symmetry = 1; symmetry <= 4; ++symmetry) {
        LdtText ldt{.c = angle_steps(0, 345, 23), .intensity = by_symmetry[symmetry]};
        const PhotometricWeb whole = ldt_web(ldt);
        ldt.symmetry = symmetry;
        const PhotometricWeb web = ldt_web(ldt);
        EXPECT_EQ(web.horizontal.size(), symmetry == 1 ? 1u : 25u);
        for (double c = 0.0; c <= 360.0; c += 7.5) {
            for (const double gamma : {0.0, 20.0, 90.0}) {
                ASSERT_NEAR(candela_at(web, gamma, c), candela_at(whole, gamma, c), 1e-9)
                    << symmetry << ' ' << gamma << ' ' << c;
            }
        }
    }
}

// Cosine, even and one-plane emitters of closed form: the file's lumens are the web's.
TEST(LdtFile, TheFluxIsTheLuminaires) {
    const double pi = std::numbers::pi;
    LdtText cosine{.symmetry = 1, .gamma = angle_steps(0, 90, 90)};
    cosine.intensity = [&](double g, double) { return 800.0 / pi * std::cos(g * kDegree); };
    const PhotometricWeb web = ldt_web(cosine);
    EXPECT_NEAR(lumens(web) / web.stated_lumens.value(), 1.0, 1e-4);  // steps of a degree
    EXPECT_NEAR(lumens(web, 60.0) / lumens(web), 0.75, 1e-4);         // sin^2 60
    LdtText even{.symmetry = 1, .gamma = {0, 90, 180}};
    even.intensity = [&](double, double) { return 800.0 / (4.0 * pi); };
    EXPECT_NEAR(lumens(ldt_web(even)), 1600.0, 1e-9);
    EXPECT_NEAR(lumens(ldt_web(even), 90.0), 800.0, 1e-9);
    EXPECT_NEAR(lumens(ldt_web(even), 60.0), 400.0, 1e-9);
}

// Its text is LM-63 with the same bits, as scenes are written with.
TEST(LdtFile, ItsTextIsAnIesFile) {
    const PhotometricWeb web = ldt_web({.c = angle_steps(0, 345, 23), .intensity = by_gamma_and_c});
    const PhotometricWeb again = read_photometric_web(web.text, "x.ies");
    EXPECT_EQ(again.vertical, web.vertical);
    EXPECT_EQ(again.horizontal, web.horizontal);
    EXPECT_EQ(again.candela, web.candela);
    EXPECT_EQ(again.stated_lumens, web.stated_lumens);
    EXPECT_EQ(again.text, web.text);
}

TEST(LdtFile, AMakersNameMayBeginAsIesFilesDo) {
    const std::string text = ldt_text({});
    std::string named = text;
    named.replace(named.find("Maker"), 5, "IESA Leuchten");
    EXPECT_EQ(read_photometric_web(named, "").candela, read_photometric_web(text, "").candela);
}

TEST(LdtFile, WhatCannotBeUsedIsRefusedInALine) {
    expect_ldt_refused({.symmetry = 3, .c = {0, 120, 240}}, "3 C-planes are no multiple of 4");
    expect_ldt_refused({.symmetry = 2, .c = {0, 90, 170, 270}},
                       "C-plane 3 is at 170, must be at 180");
    expect_ldt_refused({.symmetry = 3, .c = {0, 90, 180, 280}},
                       "C-plane 4 is at 280, must be at 270");
    expect_ldt_refused({.symmetry = 4, .c = {0, 80, 180, 270}},
                       "C-plane 2 is at 80, must be at 90");
    expect_ldt_refused({.c = {10, 90, 180, 270}}, "C-plane 1 is at 10, must be at 0");
    expect_ldt_refused({.c = {0, 90, 180}}, "the last of 3 C-planes is at 180, which leaves a gap");
    expect_ldt_refused({.c = {0, 90, 180, 400}}, "C-planes are from 0 to 400");
    expect_ldt_refused({.c = {0, 90, 90, 270}}, "line 45: C-planes must rise, 90 follows 90");
    expect_ldt_refused({.gamma = {0, 45, 80}}, "vertical angles are from 0 to 80");
    expect_ldt_refused({.gamma = {0, 60, 50, 90}},
                       "line 49: gamma angles must rise, 50 follows 60");
    expect_ldt_refused({.gamma = {0}}, "line 6: the number of gamma angles is 1");
    expect_ldt_refused({.lumens = 0}, "line 29: the lamps' luminous flux is 0");
    expect_ldt_refused({.lumens = 1e300, .conversion = 1e300}, "the largest intensity is inf");
    expect_ldt_refused({.conversion = -1}, "line 24: the conversion factor is -1");
    expect_ldt_refused({.down_percent = 101}, "line 22: the downward flux fraction is 101");
    expect_ldt_refused({.output_percent = -1}, "line 23: the light output ratio is -1");
    expect_ldt_refused({.intensity = [](double g, double) { return 50 - g; }},
                       "line 52: a candela value is -40, must be at least 0");
    LdtText no_set;
    no_set.sets = 0;
    expect_ldt_refused(no_set, "line 26: the number of lamp sets is 0");
}

TEST(LdtFile, BrokenNumbersAreShownWithTheirLine) {
    const std::string text = ldt_text({});
    std::string spoilt = text;
    spoilt.replace(spoilt.find("\n2000\n"), 6, "\n2oo\xb0\n");
    EXPECT_EQ(ldt_refusal(spoilt),
              "x.ldt: line 29: the lamps' luminous flux is '2oo?', must be a number");
    EXPECT_EQ(ldt_refusal(text + "17\n"), "x.ldt: line 62: '17' follows the last candela value");
    for (std::size_t cut = 20; cut + 2 < text.size(); ++cut) {
        const std::string message = ldt_refusal(text.substr(0, cut));
        ASSERT_TRUE(message.starts_with("x.ldt: line ")) << cut << ' ' << message;
        ASSERT_EQ(message.find('\n'), std::string::npos) << message;
    }
    std::string symmetry = text;
    symmetry.replace(symmetry.find("3\n0\n4\n"), 6, "3\n5\n4\n");
    EXPECT_EQ(ldt_refusal(symmetry), "x.ldt: line 3: the symmetry is 5, must be 0 to 4");
}

}  // namespace
}  // namespace kilolux
