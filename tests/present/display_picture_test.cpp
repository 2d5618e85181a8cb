// SPDX-License-Identifier: Apache-2.0
// 16 bits and OpenColorIO.
#include <gtest/gtest.h>
#include <cmath>
#include <cstdlib>

#include "host/base/error.h"
#include "host/render/environment_light.h"
#include "present/image/display_picture.h"
#include "present/image/read.h"
#include "tests/support/child.h"
#include "tests/support/environment_variable.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

// Two views of the display: one halves light, one squares it.
constexpr const char* kConfig = R"(ocio_profile_version: 1
search_path: ""
roles:
  scene_linear: lin_srgb
  default: raw
displays:
  screen:
    - !<View> {name: half, colorspace: halved}
    - !<View> {name: square, colorspace: squared}
  paper:
    - !<View> {name: plain, colorspace: lin_srgb}
active_displays: [screen, paper]
active_views: [half, square, plain]
colorspaces:
  - !<ColorSpace> {name: raw, isdata: true}
  - !<ColorSpace> {name: lin_srgb}
  - !<ColorSpace>
    name: halved
    from_reference: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}
  - !<ColorSpace>
    name: squared
    from_reference: !<ExponentTransform> {value: [2, 2, 2, 1]}
)";

Frame ramp() {
    Frame frame;
    frame.width = 64;
    frame.height = 1;
    for (int i = 0; i < 64; ++i) {
        for (int c = 0; c < 3; ++c) {
            frame.radiance.push_back(static_cast<float>(i) / 63.0f * (c == 1 ? 0.5f : 1.0f));
        }
        frame.display.insert(frame.display.end(), {static_cast<std::uint8_t>(i), 7, 9, 255});
    }
    return frame;
}

TEST(DisplayPicture, IsSrgbOfTheToneCurve) {
    RenderSettings settings;
    settings.tone_curve = ToneCurve::none;
    settings.exposure = 1.0f;
    const std::vector<float> rgb = display_colours(ramp(), settings, {});
    EXPECT_EQ(rgb[0], 0.0f);
    EXPECT_EQ(rgb[3 * 63], 1.0f);
    const double linear = 2.0 * 10 / 63.0;
    EXPECT_NEAR(rgb[30], 1.055 * std::pow(linear, 1 / 2.4) - 0.055, 1e-6);
    settings.want.view = ViewKind::normal;
    EXPECT_FLOAT_EQ(display_colours(ramp(), settings, {})[3 * 20], 20.0f / 255.0f);
}

// A background of #RRGGBB has its code in pictures of 16 bits, and under OpenColorIO.
TEST(DisplayPicture, ShowsABackgroundOfTheDisplayAsItIs) {
    RenderSettings settings;
    settings.tone_curve = ToneCurve::agx;
    settings.background =
        std::make_shared<const Environment>(Environment{1, 1, {{1.0f, 0.0f, 0.0f}}, true});
    Frame frame = ramp();
    const float4 light = backdrop_of(settings).light;
    frame.radiance[90] = light.x;
    frame.radiance[91] = light.y;
    frame.radiance[92] = light.z;
    const auto expect_red = [&] {
        const std::vector<float> rgb = display_colours(frame, settings, {});
        EXPECT_EQ(rgb[90], 1.0f);
        EXPECT_EQ(rgb[91], 0.0f);
        EXPECT_EQ(rgb[92], 0.0f);
        EXPECT_NE(rgb[93], 1.0f);
    };
    expect_red();
    const TemporaryFolder folder;
    write_text(folder / "config.ocio", kConfig);
    const EnvironmentVariable set("OCIO", (folder / "config.ocio").string());
    expect_red();
}

TEST(DisplayPicture, GoesThroughTheViewThatOcioNames) {
    const TemporaryFolder folder;
    write_text(folder / "config.ocio", kConfig);
    const EnvironmentVariable set("OCIO", (folder / "config.ocio").string());
    RenderSettings settings;
    const Frame frame = ramp();
    const auto at = [&](const OcioOptions& ocio) {
        return display_colours(frame, settings, ocio)[90];
    };
    const float light = frame.radiance[90];
    EXPECT_NEAR(at({}), 0.5f * light, 1e-6f) << "the default view of the default display";
    EXPECT_NEAR(at({"screen", "square", ""}), light * light, 2e-4f);
    EXPECT_NEAR(at({"paper", "", ""}), light, 1e-6f);
    EXPECT_NEAR(at({"", "", "squared"}), 0.5f * std::sqrt(light), 2e-4f);
    settings.exposure = 1.0f;
    EXPECT_NEAR(at({}), light, 1e-6f);
    EXPECT_TRUE(uses_ocio({}));
    EXPECT_FALSE(uses_ocio({"", "none", ""}));
}

std::string ocio_message(const OcioOptions& ocio) {
    try {
        display_colours(ramp(), {}, ocio);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(DisplayPicture, NamesWhatTheConfigurationLacks) {
    const TemporaryFolder folder;
    write_text(folder / "config.ocio", kConfig);
    {
        const EnvironmentVariable set("OCIO", (folder / "config.ocio").string());
        EXPECT_TRUE(
            contains(ocio_message({"scren", "", ""}), "has no 'scren'; it has screen, paper"));
        EXPECT_TRUE(contains(ocio_message({"", "plain", ""}), "--ocio-view"));
        EXPECT_TRUE(contains(ocio_message({"", "", "nowhere"}), "--ocio-input"));
    }
    {
        const EnvironmentVariable set("OCIO", (folder / "missing.ocio").string());
        EXPECT_TRUE(contains(ocio_message({}), "missing.ocio")) << ocio_message({});
    }
    EXPECT_THROW(uses_ocio({"screen", "", ""}), UsageError) << "OCIO is not set";
}

TEST(Render, SixteenBitsAreTheEightBitsMoreFinely) {
    const TemporaryFolder folder;
    const auto render = [&](const std::string& name, std::vector<std::string> more) {
        std::vector<std::string> words = {
            "render",  "grid", "-q", "--resolution",          "64,48", "--lights", "50",
            "--bloom", "0.2",  "-o", (folder / name).string()};
        words.insert(words.end(), more.begin(), more.end());
        return run_kilolux(words);
    };
    ASSERT_EQ(render("8.png", {}).code, 0);
    const std::vector<float> eight = read_image(folder / "8.png").values;
    for (const char* name : {"16.png", "16.tif"}) {
        const ChildResult result = render(name, {"--bits", "16"});
        ASSERT_EQ(result.code, 0) << result.err;
        const std::vector<float> sixteen = read_image(folder / name).values;
        ASSERT_EQ(sixteen.size(), eight.size());
        std::size_t between = 0;
        for (std::size_t i = 0; i < eight.size(); ++i) {
            // Half a code of rounding, and a little for differences of the device's arithmetic.
            ASSERT_NEAR(sixteen[i], eight[i], 0.51f / 255.0f) << i;
            between += std::abs(sixteen[i] - eight[i]) > 0.1f / 255.0f;
        }
        EXPECT_GT(between, eight.size() / 4) << "the codes are those of 8 bits";
    }
    const ChildResult jpeg = render("16.jpg", {"--bits", "16"});
    EXPECT_EQ(jpeg.code, 2);
    EXPECT_TRUE(contains(jpeg.err, "cannot hold 16 bits")) << jpeg.err;
    const ChildResult ocio = render("o.png", {"--ocio-view", "half"});
    EXPECT_EQ(ocio.code, 2);
    EXPECT_TRUE(contains(ocio.err, "OCIO")) << ocio.err;
}

}  // namespace
}  // namespace kilolux
