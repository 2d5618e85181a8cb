// SPDX-License-Identifier: Apache-2.0
#include "present/cli/option_values.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/support/messages.h"

namespace kilolux {
namespace {

const std::vector<std::string> kNames = {"deferred", "forward-plus", "forward"};

TEST(OptionValues, NumbersKeepTheirRange) {
    EXPECT_EQ(parse_number("--time", "-1.5e1"), -15.0);
    EXPECT_EQ(parse_number("--time", "+2"), 2.0);
    EXPECT_EQ(parse_number("--bloom", "1", {0.0, 1.0}), 1.0);
    EXPECT_EQ(parse_number("--bloom", "0", {0.0, 1.0}), 0.0);
    EXPECT_EQ(parse_number("--light-radius", "auto", {0.0, 10.0, true}, true), 0.0);
    EXPECT_EQ(parse_number("--light-radius", "2.5", {0.0, 10.0, true}, true), 2.5);
}

TEST(OptionValues, BadNumbersNameOptionValueAndRange) {
    for (const char* text :
         {"", " ", "abc", "1x", "nan", "inf", "-inf", "1e999", "0x10", "1,2", "--5", "+-5", "1 "}) {
        const auto message = message_of<UsageError>([&] { parse_number("--time", text); });
        EXPECT_EQ(message, "--time: '" + std::string(text) + "' is not a finite number");
    }
    EXPECT_EQ(message_of<UsageError>([] {
                  parse_number("--bloom", "1.01", {0.0, 1.0});
              }),
              "--bloom: '1.01' is not a number from 0 to 1");
    EXPECT_EQ(message_of<UsageError>([] {
                  parse_number("--angle", "180", {0.0, 180.0, true});
              }),
              "--angle: '180' is not a number between 0 and 180");
    EXPECT_EQ(message_of<UsageError>([] { parse_number("--x", "-1", {0.0}); }),
              "--x: '-1' is not a finite number of at least 0");
    const NumberRange above_zero{0.0, NumberRange{}.max, true};
    EXPECT_EQ(message_of<UsageError>([&] { parse_number("--r", "0", above_zero, true); }),
              "--r: '0' is not 'auto' or a finite number above 0");
}

TEST(OptionValues, CountsAreWholeAndInRange) {
    EXPECT_EQ(parse_count("--lights", "2147483648", {0, 2147483648u}), 2147483648u);
    EXPECT_EQ(parse_count("--light-seed", "18446744073709551615", {0, UINT64_MAX}), UINT64_MAX);
    for (const char* text : {"2147483649", "-1", "1.5", "1e10", "", "0x1", "k", "5kk", "1.0005k",
                             "nan", "inf", "18446744073709551616"}) {
        const auto message = message_of<UsageError>([&] {
            parse_count("--lights", text, {0, 2147483648u});
        });
        EXPECT_EQ(message, "--lights: '" + std::string(text) +
                               "' is not a whole number from 0 to 2147483648");
    }
}

TEST(OptionValues, CountLists) {
    EXPECT_EQ(parse_counts("--resolution", "17,31", "W,H", {1, 65536}), (std::vector{17, 31}));
    for (const char* text : {"17", "17,31,1", "17,", ",31", "0,31", "17x31", "17,65537", "17,-1"}) {
        const auto message = message_of<UsageError>([&] {
            parse_counts("--resolution", text, "W,H", {1, 65536});
        });
        EXPECT_EQ(message, "--resolution: '" + std::string(text) +
                               "' is not W,H, each a whole number from 1 to 65536");
    }
}

TEST(OptionValues, VectorsAndBoxes) {
    EXPECT_EQ(parse_vector("--p", "1,-2,3.5"), glm::dvec3(1, -2, 3.5));
    const Box box = parse_box("--light-box", "-1,-2,-3,4,5,-3");
    EXPECT_EQ(box.min, glm::dvec3(-1, -2, -3));
    EXPECT_EQ(box.max, glm::dvec3(4, 5, -3));
    EXPECT_EQ(message_of<UsageError>([] { parse_vector("--p", "1,2"); }),
              "--p: '1,2' is not 3 finite numbers X,Y,Z");
    for (const char* text : {"1,2,nan", "1,2,3,4", "a,b,c", ""}) {
        EXPECT_THROW(parse_vector("--p", text), UsageError) << text;
    }
    EXPECT_TRUE(contains(message_of<UsageError>([] { parse_box("--light-box", "0,0,0,1,-1,1"); }),
                         "y0 <= y1"));
    EXPECT_THROW(parse_box("--light-box", "0,0,0,1,1"), UsageError);
}

TEST(OptionValues, FramesAndShards) {
    const auto frames = [](const char* text) { return text_of(parse_frames("--frames", text)); };
    for (const auto& [text, shown] : std::map<const char*, const char*>{{"3:12", "3:12"},
                                                                        {"3-12", "3:12"},
                                                                        {"3", "3:3"},
                                                                        {"1-8x3", "1-7x3"},
                                                                        {"3,7,20-30", "3,7,20-30"},
                                                                        {"0:4x2,9", "0-4x2,9"}}) {
        EXPECT_EQ(frames(text), shown) << text;
        EXPECT_EQ(frames(shown), shown);
    }
    EXPECT_EQ(parse_frames("--frames", "1-8x3"), FrameRange({1, 7, 3}));
    for (const char* text : {"12:3", "3:", ":3", "-1:3", "a:b", "1:2:3", "", "3,", "1-9x0", "1x2",
                             "3-x2", "2-1x3", "1,2-9,9"}) {
        EXPECT_THROW(parse_frames("--frames", text), UsageError) << text;
    }
    EXPECT_EQ(message_of<UsageError>([&] { frames("7,3-5"); }),
              "--frames: '7,3-5' is not in ascending order: frame 3 comes after 7");
    const Shard shard = parse_shard("--shard", "3/4");
    EXPECT_EQ(shard.index, 3);
    EXPECT_EQ(shard.count, 4);
    for (const char* text : {"4/4", "0/0", "-1/4", "1", "1/", "a/b", "1/2/3", "auto/", "auto/0"}) {
        const auto message = message_of<UsageError>([&] { parse_shard("--shard", text); });
        EXPECT_TRUE(contains(message, "--shard: '" + std::string(text) + "' is not I/N"))
            << message;
    }
}

TEST(OptionValues, NamesListWhatThereIsAndTheNearest) {
    EXPECT_EQ(parse_name("--renderer", "forward", kNames), 2u);
    EXPECT_EQ(message_of<UsageError>([] { parse_name("--renderer", "defered", kNames); }),
              "--renderer: 'defered' is none of deferred, forward-plus, forward; did you mean "
              "'deferred'?");
    EXPECT_EQ(message_of<UsageError>([] { parse_name("--renderer", "raytraced", kNames); }),
              "--renderer: 'raytraced' is none of deferred, forward-plus, forward");
    EXPECT_EQ(parse_name_list("--aov", "forward,deferred,forward", kNames),
              (std::vector<std::string>{"forward", "deferred"}));
    EXPECT_TRUE(parse_name_list("--aov", "none", kNames).empty());
    EXPECT_THROW(parse_name_list("--aov", "forward,", kNames), UsageError);
    EXPECT_THROW(parse_name_list("--aov", "forward deferred", kNames), UsageError);
}

TEST(OptionValues, LineWidthsAreMetresOrPercent) {
    EXPECT_EQ(parse_line_width("--line-width", "0.25"), (LineWidth{0.25, true}));
    EXPECT_EQ(parse_line_width("--line-width", "50%"), (LineWidth{0.5, false}));
    EXPECT_EQ(text_of(LineWidth{}), "0.2%") << "as --help says";
    EXPECT_EQ(text_of(LineWidth{0.25, true}), "0.25");
    for (const char* odd : {"", "%", "0", "-1", "0%", "1m", "nan", "1e999"}) {
        EXPECT_THROW(parse_line_width("--line-width", odd), UsageError) << odd;
    }
}

TEST(OptionValues, BackgroundsAreColoursOrNone) {
    using Kind = BackgroundChoice::Kind;
    const auto parsed = [](const char* text) { return parse_background("--background", text); };
    EXPECT_EQ(parsed("auto"), BackgroundChoice{});
    EXPECT_EQ(parsed("none").kind, Kind::none);
    EXPECT_EQ(parsed("0,0.5,8").color, glm::vec3(0.0f, 0.5f, 8.0f));
    EXPECT_EQ(parsed("#ff0080").kind, Kind::color);
    EXPECT_EQ(parsed("#ff0080").color.x, 1.0f);
    EXPECT_NEAR(parsed("ff0080").color.z, 0.2158605f, 1e-6f) << "sRGB code 128";
    EXPECT_TRUE(parsed("#ff0080").as_shown);
    EXPECT_FALSE(parsed("1,0,0.5").as_shown);
    for (const char* text : {"auto", "none", "0,0.5,8", "#ff0080", "#0102fe"})
        EXPECT_EQ(text_of(parsed(text)), text);
    for (const char* bad : {"", "#ff00", "#ff00zz", "1,2", "1,2,-3", "1,2,nan", "1,2,3,4", "red"}) {
        EXPECT_EQ(message_of<UsageError>([&] { parsed(bad); }),
                  "--background: '" + std::string(bad) +
                      "' is not 'auto', 'none', or a colour: R,G,B as linear light, each at least "
                      "0, or #RRGGBB as the display shows it");
    }
}

TEST(OptionValues, ListsHaveNoEmptyNames) {
    EXPECT_EQ(parse_list("--clip", "a, b c,2"), (std::vector<std::string>{"a", "b c", "2"}));
    for (const char* odd : {"", "a,", ",a", "a,,b", " "}) {
        EXPECT_THROW(parse_list("--clip", odd), UsageError) << odd;
    }
}

}  // namespace
}  // namespace kilolux
