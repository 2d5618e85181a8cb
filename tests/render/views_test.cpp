// SPDX-License-Identifier: Apache-2.0
// The pictures of --show: each view from a real frame, and the canvas.
#include "host/picture/views.h"

#include <cmath>
#include <map>
#include <set>

#include "host/base/error.h"
#include "host/picture/view_canvas.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

constexpr int kViewWidth = 160;
constexpr int kViewHeight = 90;

Frame frame_of(const std::string& view, RendererKind renderer = RendererKind::deferred,
               std::vector<std::string> aovs = {}, Shadows shadows = Shadows::off) {
    static const Scene scene = make_generated_scene("grid");
    RenderSettings settings = small_settings(kViewWidth, kViewHeight, 200);
    settings.want.view = parse_view(view);
    settings.renderer = renderer;
    settings.shadows = shadows;
    settings.want.aovs = std::move(aovs);
    return render_once(scene, settings);
}

DisplayColor color_at(const std::vector<std::uint8_t>& rgba, int x, int y) {
    const std::size_t i =
        4 * (static_cast<std::size_t>(y) * kViewWidth + static_cast<std::size_t>(x));
    return {rgba[i], rgba[i + 1], rgba[i + 2]};
}

TEST(Views, EachIsAPictureOfItsOwnAndLeavesTheRadianceAlone) {
    const Frame lit = frame_of("lit");
    const Frame shadowed = frame_of("lit", RendererKind::deferred, {}, Shadows::exact);
    std::set<std::string> pictures;
    for (const std::string& name : view_names()) {
        const bool shadows = name == "shadows";
        const Frame frame =
            frame_of(name, RendererKind::deferred, {}, shadows ? Shadows::exact : Shadows::off);
        EXPECT_EQ(frame.radiance, (shadows ? shadowed : lit).radiance) << name;
        ASSERT_EQ(frame.display.size(), std::size_t{4} * kViewWidth * kViewHeight) << name;
        for (std::size_t i = 3; i < frame.display.size(); i += 4) ASSERT_EQ(frame.display[i], 255);
        EXPECT_TRUE(pictures.insert({frame.display.begin(), frame.display.end()}).second)
            << name << " looks like another view";
    }
    EXPECT_EQ(view_names().front(), "lit");
}

TEST(Views, UnknownNamesAreUsageErrors) {
    EXPECT_THROW(frame_of("nonsense"), UsageError);
    EXPECT_THROW(frame_of("false-positives", RendererKind::forward), UsageError);
}

// Pixels above the legend.
template <typename Visit>
void for_upper_half(const Visit& visit) {
    for (int y = 0; y < kViewHeight / 2; ++y) {
        for (int x = 0; x < kViewWidth; ++x)
            visit(x, y, static_cast<std::size_t>(y * kViewWidth + x));
    }
}

TEST(Views, LightsAreTheCountsOfTheAov) {
    for (const RendererKind renderer : {RendererKind::deferred, RendererKind::forward_plus}) {
        const Frame frame = frame_of("lights", renderer, {"light-count", "depth"});
        const std::vector<std::uint32_t>& counts = frame.aovs[0].ids;
        const auto most = static_cast<float>(*std::max_element(counts.begin(), counts.end()));
        ASSERT_GT(most, 1.0f);
        for_upper_half([&](int x, int y, std::size_t i) {
            const bool drawn = frame.aovs[1].values[i] != 0.0f;
            const DisplayColor expected =
                drawn ? heat_color(static_cast<float>(counts[i]) / most) : DisplayColor{};
            ASSERT_EQ(color_at(frame.display, x, y), expected) << x << ", " << y;
        });
    }
}

TEST(Views, StepsAreRound) {
    const std::pair<double, int> steps[] = {{0.099, -4}, {0.1, -3}, {0.2, -2}, {0.5, -1},
                                            {1.0, 0},    {1.99, 0}, {2.0, 1},  {4.99, 1},
                                            {5.0, 2},    {10.0, 3}, {1e6, 18}, {1e-6, -18}};
    for (const auto& [value, step] : steps) EXPECT_EQ(round_step(value), step) << value;
    const HeatScale scale = scale_in_steps(730.0, "LX");
    EXPECT_DOUBLE_EQ(scale.high, 1000.0);
    EXPECT_DOUBLE_EQ(scale.low, 0.1);
    EXPECT_DOUBLE_EQ(position_on(scale, 730.0), 11.5 / 12.0);
    EXPECT_EQ(position_on(scale, 0.0), 0.0);
    EXPECT_EQ(position_on(scale, 20.0), position_on(scale, 49.0));
    EXPECT_LT(position_on(scale, 19.9), position_on(scale, 20.0));
    EXPECT_TRUE(are_neighbour_steps(scale, position_on(scale, 19.9), position_on(scale, 20.0)));
    EXPECT_FALSE(are_neighbour_steps(scale, position_on(scale, 9.9), position_on(scale, 20.0)));
}

TEST(Views, IlluminanceIsTheAovInSteps) {
    const Frame frame = frame_of("illuminance", RendererKind::deferred, {"illuminance"});
    const std::vector<float>& lux = frame.aovs[0].values;
    const HeatScale scale = scale_in_steps(*std::ranges::max_element(lux), "LX");
    int lines = 0;
    std::set<DisplayColor> colors;
    for_upper_half([&](int x, int y, std::size_t i) {
        const DisplayColor color = color_at(frame.display, x, y);
        if (lux[i] == 0.0f) return;
        const double here = position_on(scale, lux[i]);
        const double right = position_on(scale, lux[i + (x + 1 < kViewWidth ? 1 : 0)]);
        const double below = position_on(scale, lux[i + kViewWidth]);
        if (!are_neighbour_steps(scale, here, right) && !are_neighbour_steps(scale, here, below)) {
            ASSERT_EQ(color, heat_color(here)) << x << ", " << y;
            colors.insert(color);
        } else {
            ASSERT_EQ(color, (DisplayColor{128, 128, 128})) << x << ", " << y;
            ++lines;
        }
    });
    EXPECT_GT(lines, 20);
    EXPECT_GT(colors.size(), 3u);
}

TEST(Views, NormalsAndAlbedoAreTheAovs) {
    const Frame normal = frame_of("normal", RendererKind::deferred, {"normal", "depth"});
    const Frame albedo = frame_of("albedo", RendererKind::deferred, {"albedo", "depth"});
    for (int i = 0; i < kViewWidth * kViewHeight; ++i) {
        const auto pixel = static_cast<std::size_t>(i);
        if (normal.aovs[1].values[pixel] == 0.0f) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            const float n = normal.aovs[0].values[3 * pixel + c];
            ASSERT_NEAR(normal.display[4 * pixel + c], (0.5f * n + 0.5f) * 255, 0.51f);
            const double a = albedo.aovs[0].values[3 * pixel + c];
            const double code =
                255 * (a <= 0.0031308 ? 12.92 * a : 1.055 * std::pow(a, 1 / 2.4) - 0.055);
            ASSERT_NEAR(albedo.display[4 * pixel + c], code, 0.51);
        }
    }
}

TEST(Views, ClustersFollowTheAov) {
    const Frame frame = frame_of("clusters", RendererKind::deferred, {"cluster", "depth"});
    // A colour's ratios of channels survive the shading of shapes; equal clusters have equal
    // ratios.
    std::map<std::uint32_t, glm::dvec3> seen;
    for (std::size_t i = 0; i < frame.aovs[0].ids.size(); ++i) {
        const glm::dvec3 color(frame.display[4 * i], frame.display[4 * i + 1],
                               frame.display[4 * i + 2]);
        if (frame.aovs[1].values[i] == 0.0f) {
            EXPECT_EQ(color, glm::dvec3(0.0));
            continue;
        }
        const auto found = seen.try_emplace(frame.aovs[0].ids[i], color).first;
        ASSERT_LT(glm::length(glm::normalize(found->second) - glm::normalize(color)), 0.03);
    }
    EXPECT_GT(seen.size(), 10u);
}

TEST(Views, DifferenceOfDeferredIsNothing) {
    const Frame same = frame_of("difference", RendererKind::deferred, {"depth"});
    const Frame other = frame_of("difference", RendererKind::forward, {"depth"});
    bool any = false;
    for_upper_half([&](int x, int y, std::size_t i) {
        const bool drawn = same.aovs[0].values[i] != 0.0f;
        const DisplayColor nothing = drawn ? heat_color(0.0) : DisplayColor{};
        ASSERT_EQ(color_at(same.display, x, y), nothing);
        any = any || color_at(other.display, x, y) != nothing;
    });
    EXPECT_TRUE(any) << "8-bit albedo differs from forward's";
}

TEST(ViewCanvas, HeatRisesInLightness) {
    double last = -1.0;
    for (int i = 0; i <= 100; ++i) {
        const DisplayColor c = heat_color(i / 100.0);
        const double luma = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
        EXPECT_GE(luma, last) << i;
        last = luma;
    }
    EXPECT_EQ(heat_color(-1.0), heat_color(0.0));
    EXPECT_EQ(heat_color(2.0), heat_color(1.0));
}

TEST(ViewCanvas, ScalesAreLinearOrLogarithmic) {
    EXPECT_DOUBLE_EQ(position_on({0.0, 10.0, false, ""}, 5.0), 0.5);
    EXPECT_DOUBLE_EQ(position_on({1.0, 100.0, true, ""}, 10.0), 0.5);
    EXPECT_DOUBLE_EQ(position_on({1.0, 100.0, true, ""}, 0.0), 0.0);
}

TEST(ViewCanvas, TextIsDrawnAndClipped) {
    const auto ink = [](const Canvas& canvas, int x0, int x1) {
        int sum = 0;
        for (int y = 0; y < canvas.height; ++y) {
            for (int x = x0; x < x1; ++x)
                sum += canvas.rgba[static_cast<std::size_t>(4 * (y * canvas.width + x))];
        }
        return sum;
    };
    Canvas canvas = make_canvas(60, 20);
    const int width = draw_text(canvas, 1, 1, 16, "1 8");
    EXPECT_GT(width, 20);
    EXPECT_LT(width, 50);
    const int third = width / 3;
    EXPECT_GT(ink(canvas, 1, third), 0);
    EXPECT_EQ(ink(canvas, third + 2, 2 * third - 1), 0) << "the space";
    EXPECT_GT(ink(canvas, 2 * third, width + 1), ink(canvas, 1, third))
        << "an 8 has more ink than a 1";
    EXPECT_EQ(ink(canvas, width + 2, 60), 0);
    draw_text(canvas, -30, -3, 16, "888888888888");
    draw_legend(canvas, {});
    Canvas tiny = make_canvas(1, 1);
    draw_legend(tiny, {});
    EXPECT_EQ(tiny.rgba, (std::vector<std::uint8_t>{0, 0, 0, 255}));
}

TEST(ViewCanvas, LegendHasTheBarAndThreeNumbers) {
    Canvas canvas = make_canvas(160, 90);
    draw_legend(canvas, {0.0, 8.0, false, "LIGHTS"});
    const auto ink = [&](int x0, int x1) {
        int count = 0;
        for (int y = 66; y < 90; ++y) {
            for (int x = x0; x < x1; ++x) {
                const auto i = static_cast<std::size_t>(4 * (y * 160 + x));
                count += canvas.rgba[i] > 100 && canvas.rgba[i] == canvas.rgba[i + 2];
            }
        }
        return count;
    };
    for (const int x : {0, 45, 90}) EXPECT_GT(ink(x, x + 14), 5) << x;
    EXPECT_GT(ink(106, 150), 40);
    EXPECT_EQ(canvas.rgba[0], 0);
}

}  // namespace
}  // namespace kilolux
