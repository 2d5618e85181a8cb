// SPDX-License-Identifier: Apache-2.0
// KHR_materials_pbrSpecularGlossiness: what its conversion to metallic-roughness keeps, and what it
// costs.
#include "host/scene/gltf/material/specular_glossiness.h"

#include <gtest/gtest.h>

#include "host/base/srgb.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

using nlohmann::json;

// Of a surface head on, per channel.
struct Reflectance {
    glm::dvec3 diffuse{0.0};
    glm::dvec3 specular{0.0};
};

// KHR_materials_pbrSpecularGlossiness, section "Specular - Glossiness".
Reflectance reflectance(const SpecularGlossiness& s) {
    const double strength = std::max({s.specular.x, s.specular.y, s.specular.z});
    return {s.diffuse * (1.0 - strength), s.specular};
}

// glTF 2.0 as of that extension: a dielectric reflects 0.04 and scatters the rest.
Reflectance reflectance(const MetallicRoughness& m) {
    return {m.base_color * (1.0 - 0.04) * (1.0 - m.metallic),
            glm::mix(glm::dvec3(0.04), m.base_color, m.metallic)};
}

// Largest differences of any channel, and means of those of each surface.
struct ConversionError {
    double diffuse = 0.0;
    double specular = 0.0;
    double mean_diffuse = 0.0;
    double mean_specular = 0.0;
    int count = 0;

    void add(const glm::dvec3& diffuse_color, const glm::dvec3& specular_color) {
        const SpecularGlossiness from{diffuse_color, specular_color, 0.25};
        const MetallicRoughness made = metallic_roughness_of(from);
        EXPECT_EQ(made.roughness, 0.75);
        const Reflectance was = reflectance(from);
        const Reflectance is = reflectance(made);
        const glm::dvec3 d = glm::abs(is.diffuse - was.diffuse);
        const glm::dvec3 s = glm::abs(is.specular - was.specular);
        diffuse = std::max({diffuse, d.x, d.y, d.z});
        specular = std::max({specular, s.x, s.y, s.z});
        mean_diffuse += std::max({d.x, d.y, d.z});
        mean_specular += std::max({s.x, s.y, s.z});
        ++count;
    }
};

// Calls `visit` with each colour of a grid over the cube.
template <typename Visit>
void each_color(int steps, const Visit& visit) {
    for (int r = 0; r <= steps; ++r) {
        for (int g = 0; g <= steps; ++g) {
            for (int b = 0; b <= steps; ++b) visit(glm::dvec3(r, g, b) / double(steps));
        }
    }
}

constexpr double kRounding = 1e-13;  // of a few operations of double on values up to 1 / 0.04

TEST(SpecularGlossiness, GreySurfacesAreConvertedExactly) {
    ConversionError error;
    for (int d = 0; d <= 100; ++d) {
        for (int s = 4; s <= 100; ++s) error.add(glm::dvec3(0.01 * d), glm::dvec3(0.01 * s));
    }
    EXPECT_LT(error.diffuse, kRounding);
    EXPECT_LT(error.specular, kRounding);
}

// Values of the extension's conversion, computed outside of this code.
TEST(SpecularGlossiness, ColouredSurfacesAreConvertedAsTheExtensionsAppendixDoes) {
    const MetallicRoughness made = metallic_roughness_of({{0.2, 0.4, 0.6}, {0.3, 0.2, 0.1}, 0.5});
    EXPECT_NEAR(made.metallic, 0.4217802544308445, kRounding);
    EXPECT_NEAR(made.base_color.x, 0.32412176324429426, kRounding);
    EXPECT_NEAR(made.base_color.y, 0.4892866915723746, kRounding);
    EXPECT_NEAR(made.base_color.z, 0.654451619900455, kRounding);
}

TEST(SpecularGlossiness, MetalsAndOrdinaryDielectricsOfAnyColourAreConvertedExactly) {
    ConversionError error;
    each_color(12, [&](const glm::dvec3& color) {
        error.add(glm::dvec3(0.0), glm::max(color, glm::dvec3(0.04)));
        // Where diffuse is darker than 0.04 a metal would do, too, and rounding decides.
        error.add(glm::max(color, glm::dvec3(0.04)), glm::dvec3(0.04));
    });
    EXPECT_LT(error.diffuse, kRounding);
    EXPECT_LT(error.specular, kRounding);
}

// A metallic-roughness surface cannot reflect less: what is missing is 0.04 of both.
TEST(SpecularGlossiness, ReflectancesBelowAnOrdinaryDielectricsBecomeThat) {
    ConversionError error;
    each_color(10, [&](const glm::dvec3& color) { error.add(color, glm::dvec3(0.0)); });
    EXPECT_LE(error.diffuse, 0.04 + kRounding);
    EXPECT_LE(error.specular, 0.04 + kRounding);
}

// The bounds that host/scene/README.md states. A grid's worst is below the cube's; the bounds leave
// room for that.
TEST(SpecularGlossiness, ErrorsOfColouredSurfacesAreBounded) {
    ConversionError plastics;  // coloured, with a grey highlight of up to twice the usual one
    each_color(10, [&](const glm::dvec3& color) {
        for (int s = 0; s <= 8; ++s) plastics.add(color, glm::dvec3(0.01 * s));
    });
    EXPECT_LT(plastics.diffuse, 0.08);
    EXPECT_LT(plastics.specular, 0.10);
    ConversionError all;
    each_color(5, [&](const glm::dvec3& diffuse) {
        each_color(5, [&](const glm::dvec3& specular) { all.add(diffuse, specular); });
    });
    EXPECT_LT(all.diffuse, 0.28);
    EXPECT_LT(all.specular, 0.68);
    EXPECT_LT(all.mean_diffuse / all.count, 0.05);
    EXPECT_LT(all.mean_specular / all.count, 0.12);
    EXPECT_GT(all.specular, 0.5) << "the bounds say something";
}

constexpr const char* kName = "KHR_materials_pbrSpecularGlossiness";

GltfBuilder file_with(const json& extension) {
    GltfBuilder file = triangle_file();
    file.root["extensionsRequired"] = {kName};
    file.add("materials", {{"name", "old"},
                           {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}},
                           {"extensions", {{kName, extension}}}});
    return file;
}

TEST(SpecularGlossiness, FactorsWinOverTheFallbackAndHaveDefaults) {
    const Material metal = load(file_with({{"diffuseFactor", {0, 0, 0, 0.5}},
                                           {"specularFactor", {1.0, 0.75, 0.25}},
                                           {"glossinessFactor", 0.875}}))
                               .materials.at(0);
    EXPECT_EQ(metal.metallic, 1.0f);
    EXPECT_EQ(metal.base_color, glm::vec4(1.0f, 0.75f, 0.25f, 0.5f));
    EXPECT_EQ(metal.roughness, 0.125f);
    const Material mirror = load(file_with({{"glossinessFactor", 1}})).materials.at(0);
    EXPECT_EQ(mirror.base_color, glm::vec4(1.0f)) << "all white by default";
    EXPECT_EQ(mirror.metallic, 1.0f);
    EXPECT_EQ(mirror.roughness, 0.0f);
}

TEST(SpecularGlossiness, TheWarningNamesWhatConvertsExactlyAndStrictRefuses) {
    testing::internal::CaptureStderr();
    load(file_with({{"glossinessFactor", 1}}));
    const std::string warning = testing::internal::GetCapturedStderr();
    EXPECT_TRUE(contains(warning, "1 specular-glossiness materials are converted")) << warning;
    EXPECT_TRUE(contains(warning, "gltf-transform metalrough in.glb out.glb")) << warning;
    LoadOptions strict;
    strict.strict = true;
    EXPECT_TRUE(contains(message_of<Error>([&] {
                             load(file_with({{"glossinessFactor", 1}}), strict);
                         }),
                         "--strict: 1 specular-glossiness materials"));
}

const Image& image_of(const Scene& scene, const TextureUse& use) {
    const auto texture = static_cast<std::size_t>(use.texture);
    return scene.images.at(static_cast<std::size_t>(scene.textures.at(texture).image));
}

// What the conversion gives for source texels of 8 bits.
void expect_texel(const Scene& scene, const glm::ivec2& place, const std::array<int, 4>& diffuse,
                  const std::array<int, 4>& glossy) {
    const auto linear = [](int code) { return srgb_to_linear(code / 255.0); };
    const MetallicRoughness made =
        metallic_roughness_of({{0.5 * linear(diffuse[0]), linear(diffuse[1]), linear(diffuse[2])},
                               {linear(glossy[0]), linear(glossy[1]), linear(glossy[2])},
                               0.75 * glossy[3] / 255.0});
    const Material& material = scene.materials.at(0);
    const Image& base = image_of(scene, material.base_color_texture);
    const Image& maps = image_of(scene, material.metallic_roughness_texture);
    const auto texel = 4 * static_cast<std::size_t>(place.y * base.width + place.x);
    for (std::size_t c = 0; c < 3; ++c) {
        const double code = 255.0 * linear_to_srgb(made.base_color[static_cast<int>(c)]);
        EXPECT_NEAR(base.rgba.at(texel + c), code, 0.501) << place.x << " " << place.y;
    }
    EXPECT_EQ(base.rgba.at(texel + 3), diffuse[3]);
    EXPECT_NEAR(maps.rgba.at(texel + 1), 255.0 * made.roughness, 0.501);
    EXPECT_NEAR(maps.rgba.at(texel + 2), 255.0 * made.metallic, 0.501);
}

json textured() {
    return {{"diffuseFactor", {0.5, 1, 1, 0.25}},
            {"glossinessFactor", 0.75},
            {"diffuseTexture", {{"index", 0}}},
            {"specularGlossinessTexture", {{"index", 1}}}};
}

GltfBuilder textured_file(const json& extension, int glossy_width) {
    GltfBuilder file = file_with(extension);
    const Blob diffuse = {200, 20, 90, 255, 10, 240, 5, 128};
    const Blob glossy = {230, 180, 90, 200, 40, 40, 60, 100};
    file.add_texture(encode_image("png", 2, 4, diffuse), "image/png");
    file.add_texture(
        encode_image("png", glossy_width, 4, {glossy.begin(), glossy.begin() + 4 * glossy_width}),
        "image/png");
    return file;
}

TEST(SpecularGlossiness, TexturesAreConvertedTexelByTexel) {
    const Scene scene = load(textured_file(textured(), 2));
    EXPECT_EQ(scene_defect(scene), "");
    ASSERT_EQ(scene.images.size(), 2u) << "the sources are not kept";
    expect_texel(scene, {0, 0}, {200, 20, 90, 255}, {230, 180, 90, 200});
    expect_texel(scene, {1, 0}, {10, 240, 5, 128}, {40, 40, 60, 100});
    const Material& material = scene.materials.at(0);
    EXPECT_EQ(material.base_color, glm::vec4(1.0f, 1.0f, 1.0f, 0.25f)) << "opacity stays a factor";
    EXPECT_EQ(material.metallic, 1.0f);
    EXPECT_EQ(material.roughness, 1.0f);
}

TEST(SpecularGlossiness, ASmallerTextureIsStretchedOverTheLargerOne) {
    const Scene scene = load(textured_file(textured(), 1));
    expect_texel(scene, {0, 0}, {200, 20, 90, 255}, {230, 180, 90, 200});
    expect_texel(scene, {1, 0}, {10, 240, 5, 128}, {230, 180, 90, 200});
}

TEST(SpecularGlossiness, AMissingTextureIsWhite) {
    json extension = textured();
    extension.erase("specularGlossinessTexture");
    const Scene without_specular = load(textured_file(extension, 2));
    expect_texel(without_specular, {1, 0}, {10, 240, 5, 128}, {255, 255, 255, 255});
    extension = textured();
    extension.erase("diffuseTexture");
    const Scene without_diffuse = load(textured_file(extension, 2));
    expect_texel(without_diffuse, {1, 0}, {255, 255, 255, 255}, {40, 40, 60, 100});
}

TEST(SpecularGlossiness, TransformsAndTexcoordsStay) {
    json extension = textured();
    for (const char* slot : {"diffuseTexture", "specularGlossinessTexture"}) {
        extension[slot]["texCoord"] = 1;
        extension[slot]["extensions"]["KHR_texture_transform"]["offset"] = {0.5, 0};
    }
    const Scene scene = load(textured_file(extension, 2));
    const Material& material = scene.materials.at(0);
    for (const TextureUse* use :
         {&material.base_color_texture, &material.metallic_roughness_texture}) {
        EXPECT_EQ(use->uv_set, 1);
        EXPECT_EQ(use->uv_from_texcoord[2].x, 0.5f);
    }
    expect_texel(scene, {0, 0}, {200, 20, 90, 255}, {230, 180, 90, 200});
}

// Texels of both cannot be paired: each is converted with the other's mean, and a warning says so.
TEST(SpecularGlossiness, TexturesLaidOutInTwoWaysUseTheOthersMean) {
    json extension = textured();
    extension["diffuseTexture"]["texCoord"] = 1;
    testing::internal::CaptureStderr();
    const Scene scene = load(textured_file(extension, 1));
    EXPECT_TRUE(contains(testing::internal::GetCapturedStderr(),
                         "material 'old' lays its diffuse and specular textures out in two ways"));
    EXPECT_EQ(scene.materials.at(0).base_color_texture.uv_set, 1);
    EXPECT_EQ(scene.materials.at(0).metallic_roughness_texture.uv_set, 0);
    EXPECT_EQ(image_of(scene, scene.materials.at(0).base_color_texture).width, 2);
    EXPECT_EQ(image_of(scene, scene.materials.at(0).metallic_roughness_texture).width, 1);
}

TEST(SpecularGlossiness, MaterialsOfTheSameTexturesShareTheConvertedOnes) {
    GltfBuilder file = textured_file(textured(), 2);
    file.root["materials"].push_back(file.root["materials"][0]);
    EXPECT_EQ(load(file).images.size(), 2u);
    file.root["materials"][1]["extensions"][kName]["glossinessFactor"] = 0.5;
    EXPECT_EQ(load(file).images.size(), 4u);
}

}  // namespace
}  // namespace kilolux
