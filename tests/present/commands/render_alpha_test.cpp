// SPDX-License-Identifier: Apache-2.0
// `kilolux render --background none`: PNG and EXR hold the covered share of pixels.
#include <gtest/gtest.h>

#include "host/scene/export/export_scene.h"
#include "present/image/image_file.h"
#include "present/image/read.h"
#include "tests/support/box_scene.h"
#include "tests/support/child.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

// The grid from afar: half of the picture is empty.
FloatImage cut_out(const fs::path& file, std::vector<std::string> more) {
    std::vector<std::string> words = {
        "render",    "grid", "--resolution",      "48,32",  "--rig", "studio",
        "--samples", "4",    "--camera-position", "0,3,18", "-o",    file.string()};
    words.insert(words.end(), more.begin(), more.end());
    const ChildResult result = run_kilolux(words);
    EXPECT_EQ(result.code, 0) << result.err;
    return read_image(file);
}

struct Counts {
    int clear = 0, whole = 0, partial = 0;
};

Counts counts_of(const FloatImage& image) {
    Counts out;
    for (std::size_t i = 3; i < image.values.size(); i += image.channels.size()) {
        const float alpha = image.values[i];
        ++(alpha == 0.0f ? out.clear : alpha == 1.0f ? out.whole : out.partial);
    }
    return out;
}

TEST(RenderAlpha, PicturesAreCutOutOfNoBackground) {
    const TemporaryFolder folder;
    const FloatImage exr = cut_out(folder / "a.exr", {"--background", "none"});
    const FloatImage opaque = cut_out(folder / "b.exr", {});
    ASSERT_EQ(exr.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    ASSERT_EQ(opaque.channels.size(), 3u);
    EXPECT_EQ(colour_of(exr), colour_of(opaque)) << "multiplied by alpha as it is";
    const Counts counts = counts_of(exr);
    EXPECT_GT(counts.clear, 100);
    EXPECT_GT(counts.whole, 100);
    EXPECT_GT(counts.partial, 5);
    const FloatImage png = cut_out(folder / "a.png", {"--background", "none"});
    ASSERT_EQ(png.channels.size(), 4u);
    for (std::size_t i = 3; i < exr.values.size(); i += 4) {
        ASSERT_NEAR(png.values[i], exr.values[i], 0.5 / 255.0 + 1e-6);
    }
    const FloatImage sixteen = cut_out(folder / "c.png", {"--background", "none", "--bits", "16"});
    for (std::size_t i = 3; i < exr.values.size(); i += 4) {
        ASSERT_NEAR(sixteen.values[i], exr.values[i], 0.5 / 65535.0 + 1e-6);
    }
}

TEST(RenderAlpha, CoveredPixelsKeepTheirCodes) {
    const TemporaryFolder folder;
    const FloatImage png = cut_out(folder / "a.png", {"--background", "none"});
    const FloatImage opaque = cut_out(folder / "b.png", {});
    ASSERT_EQ(opaque.channels.size(), 3u);
    for (std::size_t i = 0; i < opaque.values.size() / 3; ++i) {
        if (png.values[4 * i + 3] != 1.0f) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            ASSERT_EQ(png.values[4 * i + c], opaque.values[3 * i + c]) << i;
        }
    }
}

// A box that only glows, evenly. Compositing the PNG multiplies by alpha, while the EXR is
// multiplied already.
class GlowingBox : public testing::Test {
 protected:
    void write(float opacity) {
        Scene scene = box_scene(glm::dvec3(1.0));
        Material& material = scene.materials[0];
        material.emissive = kGlow;
        material.base_color = glm::vec4(0.0f, 0.0f, 0.0f, opacity);
        if (opacity < 1.0f) material.alpha_mode = AlphaMode::blend;
        for (const ExportedFile& part : export_scene(scene, folder_ / "box.glb").files) {
            write_text(folder_ / part.name, std::string(part.bytes.begin(), part.bytes.end()));
        }
    }
    FloatImage render(const char* name, const std::vector<std::string>& more = {}) const {
        const std::string file = (folder_ / name).string();
        std::vector<std::string> words = {"render",  (folder_ / "box.glb").string(),
                                          "-q",      "--resolution",
                                          "40,30",   "--rig",
                                          "none",    "--ambient",
                                          "0",       "--shading",
                                          "lambert", "--gbuffer",
                                          "full",    "--tonemap",
                                          "none",    "--background",
                                          "none",    "--samples",
                                          "16",      "-o",
                                          file};
        words.insert(words.end(), more.begin(), more.end());
        const ChildResult result = run_kilolux(words);
        EXPECT_EQ(result.code, 0) << result.err;
        return read_image(file);
    }

    static constexpr glm::vec3 kGlow{0.5f, 0.25f, 0.125f};
    TemporaryFolder folder_;
};

TEST_F(GlowingBox, EdgesHaveTheWholeColourInPngAndTheirShareInExr) {
    write(1.0f);
    const FloatImage exr = render("a.exr"), png = render("a.png", {"--bits", "16"});
    ASSERT_EQ(png.values.size(), exr.values.size());
    const auto inside = static_cast<std::size_t>(4 * (15 * 40 + 20));
    ASSERT_EQ(png.values[inside + 3], 1.0f);
    int edges = 0;
    for (std::size_t i = 0; i < exr.values.size(); i += 4) {
        const float alpha = exr.values[i + 3];
        edges += alpha > 0.0f && alpha < 1.0f;
        for (int c = 0; c < 3; ++c) {
            const std::size_t at = i + static_cast<std::size_t>(c);
            ASSERT_NEAR(exr.values[at], alpha * kGlow[c], 1e-5f) << i;
            const float expected =
                alpha > 0.0f ? png.values[inside + static_cast<std::size_t>(c)] : 0.0f;
            ASSERT_NEAR(png.values[at], expected, 1e-3f) << i << ", alpha " << alpha;
        }
    }
    EXPECT_GT(edges, 10);
}

TEST_F(GlowingBox, WhatBlendsLetsTheRestThrough) {
    write(0.25f);
    const FloatImage exr = render("a.exr", {"--samples", "1"});
    int blended = 0;
    for (std::size_t i = 3; i < exr.values.size(); i += 4) {
        const float alpha = exr.values[i];
        if (alpha == 0.0f) continue;
        ASSERT_NEAR(alpha, 0.25f, 1e-5f) << i;
        ++blended;
    }
    EXPECT_GT(blended, 100);
}

// Pictures without alpha, or with light beyond the surfaces, keep a black background.
TEST(RenderAlpha, OtherPicturesStayOpaque) {
    const TemporaryFolder folder;
    const std::vector<std::string> none = {"--background", "none"};
    EXPECT_EQ(cut_out(folder / "a.jpg", none).channels.size(), 3u);
    EXPECT_EQ(cut_out(folder / "a.hdr", none).channels.size(), 3u);
    EXPECT_EQ(cut_out(folder / "a.png", {"--background", "none", "--bloom", "0.1"}).channels.size(),
              3u);
    EXPECT_EQ(
        cut_out(folder / "b.png", {"--background", "none", "--show", "normal"}).channels.size(),
        3u);
    EXPECT_EQ(cut_out(folder / "c.png", {"--background", "auto"}).channels.size(), 3u);
}

}  // namespace
}  // namespace kilolux
