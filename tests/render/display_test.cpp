// SPDX-License-Identifier: Apache-2.0
// Shading can make the display picture itself: it has the bits of tone mapping the radiance.
#include <cstring>

#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

// The grid scene seen from farther off: pixels without a surface, and a ragged last tile.
struct DisplayedPicture {
    Scene scene = grid_with_every_light();
    RenderSettings settings = small_settings(83, 51);
    Camera camera() const {
        Camera c = first_camera(scene);
        c.position += 0.15 * glm::length(bounds(scene).size()) * c.world_from_view[2];
        return c;
    }
    Frame render(bool radiance) {
        settings.want.radiance = radiance;
        return Renderer(scene, settings).render(camera(), 0.25);
    }
};

// Without radiance shading makes the picture; with it, tone mapping does.
void expect_same_display(DisplayedPicture picture) {
    const Frame shaded = picture.render(false);
    const Frame mapped = picture.render(true);
    EXPECT_TRUE(shaded.stats.shaded_display);
    EXPECT_FALSE(has_stage(shaded, "tonemap"));
    EXPECT_FALSE(mapped.stats.shaded_display);
    EXPECT_TRUE(has_stage(mapped, "tonemap"));
    EXPECT_EQ(shaded.display, mapped.display);
    EXPECT_TRUE(shaded.radiance.empty());
}

TEST(ShadedDisplay, HasToneMappingsBitsByEveryCurve) {
    DisplayedPicture picture;
    picture.settings.exposure = 1.5f;
    for (const ToneCurve curve :
         {ToneCurve::none, ToneCurve::neutral, ToneCurve::aces, ToneCurve::agx}) {
        SCOPED_TRACE("tone curve " + std::to_string(static_cast<int>(curve)));
        picture.settings.tone_curve = curve;
        expect_same_display(picture);
    }
}

TEST(ShadedDisplay, HasBackgroundAndLight) {
    DisplayedPicture picture;
    const Frame frame = picture.render(false);
    std::size_t black = 0;
    for (std::size_t i = 0; i < frame.display.size(); i += 4) {
        EXPECT_EQ(frame.display[i + 3], 255);
        black += frame.display[i] + frame.display[i + 1] + frame.display[i + 2] == 0 ? 1 : 0;
    }
    EXPECT_GT(black, 100u);
    EXPECT_GT(frame.display.size() / 4 - black, 300u) << "pixels that are lit";
}

TEST(ShadedDisplay, InLaneWidths) {
    for (const int lanes : {1, 8}) {
        SCOPED_TRACE(std::to_string(lanes) + " lanes");
        DisplayedPicture picture;
        picture.settings.kernels.lanes = lanes;
        expect_same_display(picture);
    }
}

TEST(ShadedDisplay, InBandsAndLayouts) {
    DisplayedPicture picture;
    picture.settings.band_rows = 16;
    for (const uint layout : {GBUFFER_PACKED, GBUFFER_FULL}) {
        SCOPED_TRACE("layout " + std::to_string(layout));
        picture.settings.gbuffer = layout;
        expect_same_display(picture);
    }
}

TEST(ShadedDisplay, WithShadows) {
    for (const Shadows shadows : {Shadows::exact, Shadows::sampled}) {
        DisplayedPicture picture;
        picture.settings.shadows = shadows;
        expect_same_display(picture);
    }
}

TEST(ShadedDisplay, InTheCallersMemory) {
    DisplayedPicture picture;
    const Frame mapped = picture.render(true);
    picture.settings.want.radiance = false;
    const auto [width, height] = std::pair(picture.settings.width, picture.settings.height);
    std::vector<uint> pixels(display_stride(width) * static_cast<std::size_t>(height));
    Renderer renderer(picture.scene, picture.settings);
    const Frame frame = renderer.render_to(pixels, picture.camera(), 0.25);
    EXPECT_TRUE(frame.stats.shaded_display);
    for (int y = 0; y < height; ++y) {
        const auto row = static_cast<std::size_t>(4 * width);
        const auto at = static_cast<std::size_t>(y);
        ASSERT_EQ(std::memcmp(&pixels[at * display_stride(width)], &mapped.display[at * row], row),
                  0)
            << "row " << y;
    }
}

// Tone mapping makes it where other stages read or change the light, or arithmetic would differ.
TEST(ShadedDisplay, IsLeftToToneMappingElsewhere) {
    const auto expect_mapped = [](auto change) {
        DisplayedPicture picture;
        change(picture.settings);
        const Frame frame = picture.render(false);
        EXPECT_FALSE(frame.stats.shaded_display);
        EXPECT_TRUE(has_stage(frame, "tonemap"));
        const Frame other = picture.render(true);
        EXPECT_EQ(frame.display, other.display);
    };
    expect_mapped([](RenderSettings& s) { s.bloom = 0.1f; });
    expect_mapped([](RenderSettings& s) { s.samples = 2; });
    expect_mapped([](RenderSettings& s) { s.kernels.math = MathMode::native; });
    expect_mapped([](RenderSettings& s) { s.kernels.math = MathMode::fast_relaxed; });
    expect_mapped([](RenderSettings& s) { s.renderer = RendererKind::deferred_all; });
    expect_mapped([](RenderSettings& s) { s.renderer = RendererKind::forward_plus; });
    expect_mapped([](RenderSettings& s) {
        s.background = std::make_shared<const Environment>(Environment{1, 1, {glm::vec3(0.5f)}});
    });
}

}  // namespace
}  // namespace kilolux
