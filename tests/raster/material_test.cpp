// SPDX-License-Identifier: Apache-2.0
// What the geometry pass makes of textures, masks, normal maps and vertex colours.
#include <random>

#include "host/base/error.h"
#include "tests/raster/gl_fixture.h"
#include "tests/raster/texture_reference.h"

namespace kilolux {
namespace {

using MaterialTest = GlTest;

const GBufferNeeds kMaterialNeeds = make_needs(GBUFFER_FULL);

// A quad that fills 16 x 16 pixels exactly, so that a pixel (x, y) has texture coordinates
// ((x + 0.5) / 16, (y + 0.5) / 16).
HostGBuffer draw_filled(const Scene& scene) {
    return draw_gbuffer(scene, front_camera(1), 16, 16, kMaterialNeeds);
}

TEST_F(MaterialTest, ColourTexturesAreSrgbAndUpright) {
    Scene scene = one_object(quad_mesh());
    scene.materials[0].base_color = {0.5f, 1, 1, 1};
    // Upper row red-ish and green, lower row blue and grey.
    scene.materials[0].base_color_texture = add_texture(
        scene, 2, 2, {200, 0, 0, 255, 0, 100, 0, 255, 0, 0, 50, 255, 128, 128, 128, 255});
    const HostGBuffer g = draw_filled(scene);
    EXPECT_NEAR(g.vector(PLANE_ALBEDO_R, 4, 4).x, 0.5 * linear_of(200), 2e-3) << "upper left";
    EXPECT_NEAR(g.vector(PLANE_ALBEDO_R, 12, 4).y, linear_of(100), 2e-3) << "upper right";
    EXPECT_NEAR(g.vector(PLANE_ALBEDO_R, 4, 12).z, linear_of(50), 2e-3) << "lower left";
    EXPECT_NEAR(g.vector(PLANE_ALBEDO_R, 12, 12).y, linear_of(128), 2e-3) << "lower right";
}

TEST_F(MaterialTest, OneImageCanBeBothSrgbAndLinear) {
    Scene scene = one_object(quad_mesh());
    const TextureUse use = add_texture(scene, 1, 1, {255, 128, 64, 255});
    Material& material = scene.materials[0];
    material.base_color_texture = use;
    material.metallic_roughness_texture = use;
    material.occlusion_texture = use;
    material.emissive_texture = use;
    material.emissive = glm::vec3(10.0f);
    material.roughness = 0.5f;
    material.occlusion_strength = 0.5f;
    const HostGBuffer g = draw_filled(scene);
    EXPECT_NEAR(g.vector(PLANE_ALBEDO_R, 8, 8).y, linear_of(128), 2e-3);
    EXPECT_NEAR(g.vector(PLANE_EMISSIVE_R, 8, 8).y, 10 * linear_of(128), 2e-2);
    EXPECT_NEAR(g.at<float>(PLANE_ROUGHNESS, 8, 8), 0.5 * 128 / 255, 1e-5);
    EXPECT_NEAR(g.at<float>(PLANE_METALLIC, 8, 8), 64.0 / 255, 1e-5);
    EXPECT_NEAR(g.at<float>(PLANE_OCCLUSION_F, 8, 8), 1.0, 1e-5) << "red is 255";
    const GpuScene gpu(scene);
    EXPECT_EQ(gpu.image_count(), 2u);
}

TEST_F(MaterialTest, OcclusionHasItsOwnTextureAndStrength) {
    Scene scene = one_object(quad_mesh());
    scene.materials[0].occlusion_texture = add_texture(scene, 1, 1, {51, 0, 0, 255});
    scene.materials[0].metallic_roughness_texture = add_texture(scene, 1, 1, {255, 255, 255, 255});
    scene.materials[0].occlusion_strength = 0.5f;
    EXPECT_NEAR(draw_filled(scene).at<float>(PLANE_OCCLUSION_F, 8, 8), 0.6, 1e-5);
}

TEST_F(MaterialTest, SpecularTexturesColourAndWeighTheReflectance) {
    Scene scene = one_object(quad_mesh());
    Material& material = scene.materials[0];
    material.specular = 0.5f;
    material.specular_color = {1.0f, 0.5f, 100.0f};
    // The weight is the alpha of its texture, linear; the colour is sRGB.
    material.specular_texture = add_texture(scene, 1, 1, {255, 255, 255, 51});
    material.specular_color_texture = add_texture(scene, 1, 1, {128, 255, 255, 0});
    GBufferNeeds needs = make_needs(GBUFFER_FULL);
    needs.specular = true;
    const HostGBuffer g = draw_gbuffer(scene, front_camera(1), 16, 16, needs);
    const glm::dvec3 head_on(0.04 * linear_of(128), 0.04 * 0.5, 1.0);
    expect_near(g.vector(PLANE_SPECULAR_R, 8, 8), 0.1 * head_on, 1e-4, "limited, then weighed");
    EXPECT_NEAR(g.at<float>(PLANE_SPECULAR_F90, 8, 8), 0.1, 1e-5);
}

TEST_F(MaterialTest, MipmapsAverageLightNotCodes) {
    Scene scene = one_object(quad_mesh(0.01f));  // the whole texture in less than a pixel
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < 64 * 64; ++i) {
        const auto value = static_cast<std::uint8_t>(i % 2 == 0 ? 255 : 0);
        rgba.insert(rgba.end(), {value, value, value, 255});
    }
    TextureUse use = add_texture(scene, 64, 64, rgba);
    Sampler& sampler = scene.textures[0].sampler;
    sampler.mipmaps = true;
    sampler.minify = sampler.between_mipmaps = Filter::linear;
    scene.materials[0].base_color_texture = use;
    const HostGBuffer g = draw_gbuffer(scene, front_camera(0.11), 11, 11, kMaterialNeeds);
    EXPECT_NEAR(g.vector(PLANE_ALBEDO_R, 5, 5).x, 0.5, 0.01);
}

TEST_F(MaterialTest, TextureTransformAndSecondSet) {
    Mesh mesh = quad_mesh();
    mesh.texcoords[1] = {{0.25f, 0.25f}, {0.25f, 0.25f}, {0.25f, 0.25f}, {0.25f, 0.25f}};
    Scene scene = one_object(mesh);
    TextureUse use = add_texture(scene, 2, 1, {255, 0, 0, 255, 0, 255, 0, 255});
    // u' = u + 0.5: the halves change places.
    use.uv_from_texcoord[2] = {0.5f, 0, 1};
    scene.materials[0].base_color_texture = use;
    const HostGBuffer shifted = draw_filled(scene);
    EXPECT_EQ(shifted.vector(PLANE_ALBEDO_R, 4, 8), glm::dvec3(0, 1, 0));
    EXPECT_EQ(shifted.vector(PLANE_ALBEDO_R, 12, 8), glm::dvec3(1, 0, 0));
    // A quarter turn: u' = v.
    use.uv_from_texcoord = glm::mat3(0, 1, 0, 1, 0, 0, 0, 0, 1);
    scene.materials[0].base_color_texture = use;
    const HostGBuffer turned = draw_filled(scene);
    EXPECT_EQ(turned.vector(PLANE_ALBEDO_R, 8, 4), glm::dvec3(1, 0, 0));
    EXPECT_EQ(turned.vector(PLANE_ALBEDO_R, 8, 12), glm::dvec3(0, 1, 0));
    use.uv_from_texcoord = glm::mat3(1.0f);
    use.uv_set = 1;
    scene.materials[0].base_color_texture = use;
    EXPECT_EQ(draw_filled(scene).vector(PLANE_ALBEDO_R, 12, 8), glm::dvec3(1, 0, 0));
}

TEST_F(MaterialTest, WrapModes) {
    Mesh mesh = quad_mesh();
    for (glm::vec2& t : mesh.texcoords[0]) t = t * 4.0f - 2.0f;  // [-2, 2]: one texel is 2 pixels
    Scene scene = one_object(mesh);
    scene.materials[0].base_color_texture =
        add_texture(scene, 2, 1, {255, 0, 0, 255, 0, 255, 0, 255});
    const auto row = [&](Wrap wrap) {
        scene.textures[0].sampler.wrap_s = wrap;
        const HostGBuffer g = draw_filled(scene);
        std::string texels;
        for (int x = 1; x < 16; x += 2) {
            texels += g.vector(PLANE_ALBEDO_R, x, 8).x > 0.5 ? 'r' : 'g';
        }
        return texels;
    };
    EXPECT_EQ(row(Wrap::repeat), "rgrgrgrg");
    EXPECT_EQ(row(Wrap::mirror), "rggrrggr");
    EXPECT_EQ(row(Wrap::clamp), "rrrrrggg");
}

TEST_F(MaterialTest, AlphaMaskCutsBelowTheCutoff) {
    Scene scene = one_object(quad_mesh());
    Material& material = scene.materials[0];
    material.base_color_texture =
        add_texture(scene, 2, 1, {255, 255, 255, 127, 255, 255, 255, 129});
    EXPECT_GT(draw_filled(scene).depth(4, 8), 0.0f) << "opaque ignores alpha";
    material.alpha_mode = AlphaMode::mask;
    EXPECT_EQ(draw_filled(scene).depth(4, 8), 0.0f);
    EXPECT_GT(draw_filled(scene).depth(12, 8), 0.0f);
    material.base_color.w = 0.9f;
    EXPECT_EQ(draw_filled(scene).depth(12, 8), 0.0f) << "the factor counts";
    material.alpha_cutoff = 0.0f;
    EXPECT_GT(draw_filled(scene).depth(4, 8), 0.0f);
}

TEST_F(MaterialTest, VertexColoursMultiply) {
    Mesh mesh = quad_mesh();
    mesh.colors.assign(4, {0.5f, 0.25f, 1.0f, 0.4f});
    Material material;
    material.base_color = {0.5f, 1, 0.125f, 1};
    Scene scene = one_object(mesh, material);
    const glm::dvec3 albedo = draw_filled(scene).vector(PLANE_ALBEDO_R, 8, 8);
    EXPECT_NEAR(glm::length(albedo - glm::dvec3(0.25, 0.25, 0.125)), 0.0, 1e-6);
    scene.materials[0].alpha_mode = AlphaMode::mask;
    EXPECT_EQ(draw_filled(scene).depth(8, 8), 0.0f) << "vertex alpha counts";
}

// Each channel is another mean of the texture coordinates; every vertex has its own value.
TEST_F(MaterialTest, VertexColoursAreInterpolated) {
    const auto color_at = [](double u, double v) {
        return glm::vec4((u + 2 * v) / 3, (2 * u + v) / 3, (2 + u - 2 * v) / 3,
                         (3 - u - 2 * v) / 3);
    };
    Mesh mesh = quad_mesh();
    for (const glm::vec2& uv : mesh.texcoords[0]) mesh.colors.push_back(color_at(uv.x, uv.y));
    Scene scene = one_object(mesh);
    const HostGBuffer whole = draw_filled(scene);
    scene.materials[0].alpha_mode = AlphaMode::mask;
    const HostGBuffer cut = draw_filled(scene);
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
            const glm::vec4 color = color_at((x + 0.5) / 16, (y + 0.5) / 16);
            const glm::dvec3 albedo = whole.vector(PLANE_ALBEDO_R, x, y);
            EXPECT_NEAR(glm::length(albedo - glm::dvec3(color)), 0.0, 1e-6) << x << ", " << y;
            if (std::abs(color.w - 0.5f) < 1e-3f) continue;
            EXPECT_EQ(cut.depth(x, y) > 0.0f, color.w > 0.5f) << x << ", " << y;
        }
    }
}

// A normal map's texel in a quad that is turned, scaled and mirrored: the tangent goes with the
// surface, the bitangent is cross(n, t) * w in object space.
TEST_F(MaterialTest, NormalMapsFollowTangentsAndMirrors) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> scale(0.5, 2.0);
    const glm::dvec3 texel(200 / 255.0 * 2 - 1, 160 / 255.0 * 2 - 1, 220 / 255.0 * 2 - 1);
    for (int i = 0; i < 16; ++i) {
        const double side = scale(random);
        glm::dmat4 world(1.0);
        world[0][0] = (i & 1) != 0 ? -side : side;
        world[1][1] = (i & 2) != 0 ? -side : side;
        Mesh mesh = quad_mesh();
        const double w = (i & 4) != 0 ? -1.0 : 1.0;
        mesh.tangents.assign(4, {0, 1, 0, w});
        Scene scene = one_object(mesh, {}, world);
        scene.materials[0].normal_texture = add_texture(scene, 1, 1, {200, 160, 220, 255});
        scene.materials[0].normal_scale = (i & 8) != 0 ? 0.5f : 1.0f;
        const double strength = (i & 8) != 0 ? 0.5 : 1.0;
        const glm::dmat3 m(world);
        const glm::dvec3 t = glm::normalize(m * glm::dvec3(0, 1, 0));
        const glm::dvec3 b = glm::normalize(m * (glm::cross(glm::dvec3(0, 0, 1), {0, 1, 0}) * w));
        const glm::dvec3 expected = glm::normalize(strength * texel.x * t + strength * texel.y * b +
                                                   texel.z * glm::dvec3(0, 0, 1));
        const glm::dvec3 got = draw_filled(scene).vector(PLANE_NORMAL_X, 8, 8);
        expect_near(got, expected, 1e-5, "case " + std::to_string(i));
    }
}

TEST_F(MaterialTest, VariantsHoldOnlyWhatTheSceneNeeds) {
    Scene scene = one_object(quad_mesh());
    scene.materials[0].normal_texture = add_texture(scene, 1, 1, {128, 128, 255, 255});
    scene.materials.push_back(scene.materials[0]);
    scene.materials[1].emissive_texture = add_texture(scene, 1, 1, {128, 128, 255, 255});
    scene.meshes.push_back(quad_mesh());
    scene.meshes[1].material = 1;
    const GpuScene gpu(scene);
    EXPECT_EQ(GeometryPass(gpu, {}).variant_count(), 1u) << "no plane for emission, no variant";
    EXPECT_EQ(GeometryPass(gpu, kMaterialNeeds).variant_count(), 2u);
}

TEST_F(MaterialTest, ImagesTooLargeForTheDriverAreErrors) {
    Scene scene = one_object(quad_mesh());
    scene.materials[0].base_color_texture = add_texture(scene, 1 << 20, 1, {});
    EXPECT_THROW(GpuScene{scene}, Error);
}

}  // namespace
}  // namespace kilolux
