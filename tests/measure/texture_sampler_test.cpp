// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/texture_sampler.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kilolux {
namespace {

// A scene with one image used as base colour and as metallic-roughness.
Scene scene_of(int width, int height, std::vector<std::uint8_t> rgba, Sampler sampler = {}) {
    Scene scene;
    scene.images.push_back({"image", width, height, std::move(rgba)});
    scene.textures.push_back({0, sampler});
    Material material;
    material.base_color_texture.texture = 0;
    material.metallic_roughness_texture.texture = 0;
    scene.materials.push_back(material);
    return scene;
}

// Red is 10 * (x + width * y), green the column, blue the row, alpha 255.
std::vector<std::uint8_t> ramp(int width, int height) {
    std::vector<std::uint8_t> out;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (const int v : {10 * (x + width * y), x, y, 255}) {
                out.push_back(static_cast<std::uint8_t>(v));
            }
        }
    }
    return out;
}

glm::dvec4 at(const Scene& scene, glm::dvec2 uv, double texels_per_pixel = 0.0,
              TextureEncoding encoding = TextureEncoding::linear) {
    const TextureSampler sampler(scene);
    const double step = texels_per_pixel / scene.images[0].width;
    const TextureFootprint footprint{uv, {step, 0.0}, {0.0, 0.0}};
    return sampler.sample(scene.materials[0].metallic_roughness_texture, encoding,
                          {footprint, footprint});
}

Sampler nearest_sampler(Wrap wrap) {
    Sampler sampler;
    sampler.wrap_s = sampler.wrap_t = wrap;
    sampler.magnify = Filter::nearest;
    return sampler;
}

TEST(TextureSampler, TexelCentersAreTheTexels) {
    const Scene scene = scene_of(4, 3, ramp(4, 3));
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 4; ++x) {
            const glm::dvec4 v = at(scene, {(x + 0.5) / 4, (y + 0.5) / 3});
            EXPECT_NEAR(v.x * 255, 10 * (x + 4 * y), 1e-9);
            EXPECT_NEAR(v.w, 1.0, 1e-15);
        }
    }
}

TEST(TextureSampler, BilinearBetweenTexels) {
    const Scene scene = scene_of(4, 3, ramp(4, 3));
    EXPECT_NEAR(at(scene, {1.75 / 4, 1.0 / 3}).y * 255, 1.25, 1e-12);
    EXPECT_NEAR(at(scene, {1.75 / 4, 1.0 / 3}).z * 255, 0.5, 1e-12);
}

TEST(TextureSampler, WrapModes) {
    const auto column = [](Wrap wrap, double u) {
        return std::lround(at(scene_of(4, 1, ramp(4, 1), nearest_sampler(wrap)), {u, 0.5}).y * 255);
    };
    EXPECT_EQ(column(Wrap::repeat, 1.1), 0);
    EXPECT_EQ(column(Wrap::repeat, -0.1), 3);
    EXPECT_EQ(column(Wrap::clamp, 1.1), 3);
    EXPECT_EQ(column(Wrap::clamp, -7.0), 0);
    EXPECT_EQ(column(Wrap::mirror, 1.1), 3);
    EXPECT_EQ(column(Wrap::mirror, 1.9), 0);
    EXPECT_EQ(column(Wrap::mirror, -0.1), 0);
    EXPECT_EQ(column(Wrap::mirror, 2.3), 1);
    EXPECT_EQ(column(Wrap::clamp, 1e300), 3);
}

TEST(TextureSampler, SrgbIsDecodedBeforeFiltering) {
    const Scene scene = scene_of(2, 1, {0, 0, 0, 0, 255, 188, 10, 255});
    const glm::dvec4 v = at(scene, {0.5, 0.5}, 0.0, TextureEncoding::srgb);
    EXPECT_NEAR(v.x, 0.5, 1e-12);
    EXPECT_NEAR(v.y, 0.5 * std::pow((188 / 255.0 + 0.055) / 1.055, 2.4), 1e-12);
    EXPECT_NEAR(v.z, 0.5 * 10 / 255.0 / 12.92, 1e-12);
    EXPECT_NEAR(v.w, 0.5, 1e-12) << "alpha is linear";
}

TEST(TextureSampler, ReadsAllBitsOf16) {
    Scene scene = scene_of(2, 1, {});
    scene.images[0].rgba16 = {32776, 1, 65535, 65535, 32778, 3, 65535, 0};
    EXPECT_NEAR(at(scene, {0.25, 0.5}).x * 65535, 32776, 1e-9);
    EXPECT_NEAR(at(scene, {0.25, 0.5}, 2.0).x * 65535, 32777, 0.01);
    EXPECT_NEAR(at(scene, {0.25, 0.5}, 2.0).y * 65535, 2, 0.01);
}

TEST(TextureSampler, MipLevelsAverageTwoByTwo) {
    const Scene scene = scene_of(4, 4, ramp(4, 4));
    // Level 1 at its first texel: columns 0 and 1, rows 0 and 1; level 2 is the mean of all.
    EXPECT_NEAR(at(scene, {0.25, 0.25}, 2.0).y * 255, 0.5, 1e-5);
    EXPECT_NEAR(at(scene, {0.25, 0.25}, 2.0).z * 255, 0.5, 1e-5);
    EXPECT_NEAR(at(scene, {0.3, 0.9}, 4.0).y * 255, 1.5, 1e-5);
    EXPECT_NEAR(at(scene, {0.3, 0.9}, 4000.0).z * 255, 1.5, 1e-5) << "the last level";
}

TEST(TextureSampler, TrilinearBetweenLevels) {
    const Scene scene = scene_of(4, 4, ramp(4, 4));
    const glm::dvec2 uv(0.125, 0.125);
    const double level0 = at(scene, uv, 1.0).y;
    const double level1 = at(scene, uv, 2.0).y;
    const double lambda = std::log2(1.3);
    EXPECT_NEAR(at(scene, uv, 1.3).y, level0 + lambda * (level1 - level0), 1e-9);
    EXPECT_NE(level0, level1);
}

TEST(TextureSampler, OddSizesAverageWhereTheNewTexelLies) {
    // 3 texels to 1: read with a linear filter at the middle of the texture, its middle texel.
    const Scene scene = scene_of(3, 1, ramp(3, 1));
    EXPECT_NEAR(at(scene, {0.5, 0.5}, 3.0).x * 255, 10.0, 1e-5);
}

TEST(TextureSampler, FiltersOfTheSamplerAreUsed) {
    Sampler sampler = nearest_sampler(Wrap::clamp);
    sampler.minify = Filter::nearest;
    sampler.mipmaps = false;
    EXPECT_NEAR(at(scene_of(4, 1, ramp(4, 1), sampler), {0.49, 0.5}, 4.0).y * 255, 1.0, 1e-9);
    sampler.mipmaps = true;
    sampler.between_mipmaps = Filter::nearest;
    const Scene scene = scene_of(4, 1, ramp(4, 1), sampler);
    EXPECT_NEAR(at(scene, {0.1, 0.5}, std::exp2(0.45)).y * 255, 0.0, 1e-9) << "level 0";
    EXPECT_NEAR(at(scene, {0.1, 0.5}, std::exp2(0.55)).y * 255, 0.5, 1e-5) << "level 1";
}

TEST(TextureSampler, TransformsTexcoordsAndPicksTheSet) {
    const Scene scene = scene_of(4, 1, ramp(4, 1), nearest_sampler(Wrap::repeat));
    const TextureSampler sampler(scene);
    TextureUse use = scene.materials[0].base_color_texture;
    const TextureFootprint zero{{0.1, 0.5}, {}, {}}, one{{0.6, 0.5}, {}, {}};
    const auto column = [&] {
        return std::lround(sampler.sample(use, TextureEncoding::linear, {zero, one}).y * 255);
    };
    // Prepared for both encodings, as base colour and as metallic-roughness.
    EXPECT_EQ(column(), 0);
    use.uv_set = 1;
    EXPECT_EQ(column(), 2);
    use.uv_from_texcoord[2][0] = 0.25f;
    EXPECT_EQ(column(), 3);
    use.texture = -1;
    EXPECT_EQ(column(), 255) << "white";
}

}  // namespace
}  // namespace kilolux
