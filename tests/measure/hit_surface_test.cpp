// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/hit_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/quad_scene.h"

namespace kilolux {
namespace {

TEST(HitSurface, BackFacesAreSeenOnlyWhenDoubleSided) {
    Scene scene = quad_scene();
    const Camera behind = look_at({0, 0, -5}, {0, 0, 0}, {0, 1, 0}, 0.9);
    EXPECT_EQ(center_of(scene, behind).kind, SurfaceKind::background);
    scene.materials[0].double_sided = true;
    EXPECT_NEAR(center_of(scene, behind).normal.z, 1.0, kRounding) << "turned to the camera";
}

TEST(HitSurface, MirroringTransformsKeepTheFrontInFront) {
    Scene scene = quad_scene();
    scene.instances[0].world_from_object[0][0] = -1.0;
    EXPECT_EQ(center_of(scene, front_camera()).kind, SurfaceKind::lit);
    EXPECT_NEAR(center_of(scene, front_camera()).normal.z, 1.0, kRounding);
    scene.meshes[0].normals.clear();
    EXPECT_NEAR(center_of(scene, front_camera()).normal.z, 1.0, kRounding);
    scene.instances[0].world_from_object[2][2] = -1.0;
    EXPECT_EQ(center_of(scene, front_camera()).kind, SurfaceKind::background) << "turned away";
}

TEST(HitSurface, NormalsFollowTheInverseTranspose) {
    Scene scene = quad_scene();
    scene.meshes[0].normals.assign(4, glm::normalize(glm::vec3(1, 0, 1)));
    scene.instances[0].world_from_object[0][0] = 4.0;
    const glm::dvec3 normal = center_of(scene, front_camera()).normal;
    EXPECT_NEAR(normal.x / normal.z, 0.25, 1e-7);
    EXPECT_NEAR(glm::length(normal), 1.0, kRounding);
}

TEST(HitSurface, NormalsAreInterpolatedAndMadeUnit) {
    Scene scene = quad_scene(1.0f);
    scene.meshes[0].normals = {{-1, 0, 1}, {1, 0, 1}, {1, 0, 1}, {-1, 0, 1}};
    Camera camera = front_camera();
    camera.orthographic = true;
    camera.z_far = 10.0;
    camera.y_extent = 1.0;
    const SurfaceSamples samples = RayCaster(scene).cast(camera, 8, 8);
    for (int x = 0; x < 8; ++x) {
        const double at = (x + 0.5) / 4 - 1;
        EXPECT_NEAR(samples.at(x, 5).normal.x, at / std::hypot(at, 1.0), 1e-14) << x;
    }
    scene.meshes[0].normals.assign(4, {0, 0, 0});
    EXPECT_EQ(RayCaster(scene).cast(camera, 1, 1).pixels[0].normal, glm::dvec3(0, 0, 1));
}

// The texture's columns 0..255 give u, rows v; read back across a tilted plane.
TEST(HitSurface, TextureCoordinatesAreCorrectInPerspective) {
    Scene scene = quad_scene(2.0f);
    Image image{"ramp", 256, 256, {}};
    for (int i = 0; i < 256 * 256; ++i) {
        for (const int v : {i % 256, i / 256, 0, 255}) {
            image.rgba.push_back(static_cast<std::uint8_t>(v));
        }
    }
    scene.images.push_back(image);
    Sampler sampler;
    sampler.mipmaps = false;
    sampler.wrap_s = sampler.wrap_t = Wrap::clamp;
    scene.textures.push_back({0, sampler});
    scene.materials[0].metallic_roughness_texture.texture = 0;
    scene.materials[0].roughness = 1.0f;
    scene.instances[0].world_from_object =
        glm::dmat4(1, 0, 0, 0, 0, std::cos(1.0), -std::sin(1.0), 0, 0, std::sin(1.0), std::cos(1.0),
                   0, 0, 0, 0, 1);
    const Camera camera = front_camera(3.0);
    const SurfaceSamples samples = RayCaster(scene).cast(camera, 40, 40);
    const glm::dmat4 object_from_world = glm::inverse(scene.instances[0].world_from_object);
    int seen = 0;
    for (const SurfaceSample& s : samples.pixels) {
        if (s.kind == SurfaceKind::background) continue;
        const glm::dvec3 world = camera.position + camera.world_from_view * s.position;
        const double v = (2.0 - (object_from_world * glm::dvec4(world, 1)).y) / 4.0;
        const double expected = std::clamp(v * 256 - 0.5, 0.0, 255.0) / 255.0;
        EXPECT_NEAR(s.roughness, expected, 1e-12);
        ++seen;
    }
    EXPECT_GT(seen, 200);
}

// A checkerboard of texels seen from afar: the mip level follows the distance.
TEST(HitSurface, MipLevelFollowsTheFootprint) {
    Scene scene = quad_scene(16.0f);
    Image image{"columns", 64, 64, {}};
    for (int i = 0; i < 64 * 64; ++i) {
        const auto v = static_cast<std::uint8_t>(i % 2 == 0 ? 255 : 0);
        image.rgba.insert(image.rgba.end(), {v, v, v, 255});
    }
    scene.images.push_back(image);
    scene.textures.push_back({0, {}});
    scene.materials[0].metallic_roughness_texture.texture = 0;
    scene.materials[0].roughness = 1.0f;
    Camera camera = front_camera();
    camera.orthographic = true;
    camera.z_far = 10.0;
    // A texel is 0.5 m. A pixel of 0.5 m reads level 0 at texel centres; of 1 m reads level 1,
    // grey.
    camera.y_extent = 8.0;
    const SurfaceSamples fine = RayCaster(scene).cast(camera, 32, 32);
    EXPECT_NEAR(fine.at(16, 16).roughness, 1.0, 1e-12);
    EXPECT_NEAR(fine.at(17, 16).roughness, 0.0, 1e-12);
    const SurfaceSamples coarse = RayCaster(scene).cast(camera, 16, 16);
    EXPECT_NEAR(coarse.at(7, 7).roughness, 0.5, 1e-6);
}

TEST(HitSurface, AlphaMaskCutsHoles) {
    Scene scene = quad_scene();
    scene.images.push_back({"half", 2, 1, {255, 255, 255, 0, 255, 255, 255, 255}});
    Sampler nearest;
    nearest.magnify = nearest.minify = Filter::nearest;
    nearest.mipmaps = false;
    scene.textures.push_back({0, nearest});
    scene.materials[0].base_color_texture.texture = 0;
    Instance back = scene.instances[0];
    back.world_from_object[3][2] = -1.0;
    scene.instances.push_back(back);
    const auto depths = [&] {
        const SurfaceSamples s = RayCaster(scene).cast(front_camera(), 2, 1);
        const auto depth = [](const SurfaceSample& p) {
            return p.kind == SurfaceKind::background ? 0.0 : -p.position.z;
        };
        return glm::dvec2(depth(s.at(0, 0)), depth(s.at(1, 0)));
    };
    EXPECT_NEAR(depths().x, 5.0, 1e-12) << "opaque: alpha is not looked at";
    scene.materials[0].alpha_mode = AlphaMode::mask;
    EXPECT_EQ(depths().x, 0.0) << "both quads have the hole";
    EXPECT_NEAR(depths().y, 5.0, 1e-12);
    scene.materials[0].alpha_cutoff = 0.0f;
    EXPECT_NEAR(depths().x, 5.0, 1e-12);
    scene.materials[0].alpha_mode = AlphaMode::blend;
    EXPECT_EQ(depths().y, 0.0) << "not in a G-buffer";
}

// Corners' normals are normalised before interpolation: long ones weigh no more than short ones.
TEST(HitSurface, CornersNormalsCountAlike) {
    Scene scene = quad_scene(1.0f);
    scene.meshes[0].normals = {{0, 0, 9}, {3, 0, 0}, {3, 0, 0}, {0, 0, 9}};
    const glm::dvec3 normal = center_of(scene, front_camera()).normal;
    EXPECT_NEAR(normal.x, std::sqrt(0.5), 1e-14);
    EXPECT_NEAR(normal.z, std::sqrt(0.5), 1e-14);
}

TEST(HitSurface, NormalMapsUseTheBasisAsInterpolated) {
    Scene scene = quad_scene(1.0f);
    scene.images.push_back({"tilt", 1, 1, {204, 153, 204, 255}});  // (0.6, 0.2, 0.6)
    scene.textures.push_back({0, {}});
    scene.materials[0].normal_texture.texture = 0;
    const float s = std::sqrt(0.5f);
    scene.meshes[0].normals = {{-s, 0, s}, {s, 0, s}, {s, 0, s}, {-s, 0, s}};
    scene.meshes[0].tangents.assign(4, {1, 0, 0, 1});
    // In the middle the normal is (0, 0, s), the bitangent s long too.
    const glm::dvec3 expected = glm::normalize(glm::dvec3(0.6, 0.2 * s, 0.6 * s));
    EXPECT_LT(glm::distance(center_of(scene, front_camera()).normal, expected), 1e-7);
}

TEST(HitSurface, MirroredNormalMapsAreMirrored) {
    Scene scene = quad_scene();
    scene.images.push_back({"tilt", 1, 1, {204, 153, 204, 255}});
    scene.textures.push_back({0, {}});
    scene.materials[0].normal_texture.texture = 0;
    scene.meshes[0].tangents.assign(4, {1, 0, 0, 1});
    const glm::dvec3 plain = center_of(scene, front_camera()).normal;
    scene.instances[0].world_from_object[0][0] = -1.0;
    const glm::dvec3 mirrored = center_of(scene, front_camera()).normal;
    EXPECT_LT(glm::distance(mirrored, plain * glm::dvec3(-1, 1, 1)), 1e-14);
}

TEST(HitSurface, NormalMapTiltsInTheTangentFrame) {
    Scene scene = quad_scene();
    scene.images.push_back({"tilt", 1, 1, {204, 153, 204, 255}});  // (0.6, 0.2, 0.6)
    scene.textures.push_back({0, {}});
    scene.materials[0].normal_texture.texture = 0;
    EXPECT_NEAR(center_of(scene, front_camera()).normal.z, 1.0, kRounding) << "no tangents";
    for (const float handedness : {1.0f, -1.0f}) {
        scene.meshes[0].tangents.assign(4, {1, 0, 0, handedness});
        const glm::dvec3 expected = glm::normalize(glm::dvec3(0.6, 0.2 * handedness, 0.6));
        EXPECT_LT(glm::distance(center_of(scene, front_camera()).normal, expected), 1e-14);
    }
    scene.materials[0].normal_scale = 0.5f;
    const glm::dvec3 flatter = glm::normalize(glm::dvec3(0.3, -0.1, 0.6));
    EXPECT_LT(glm::distance(center_of(scene, front_camera()).normal, flatter), 1e-14);
}

TEST(HitSurface, OcclusionVertexColorsUnlitAndDefaults) {
    Scene scene = quad_scene();
    scene.images.push_back({"grey", 1, 1, {51, 0, 0, 255}});
    scene.textures.push_back({0, {}});
    scene.materials[0].occlusion_texture.texture = 0;
    scene.materials[0].occlusion_strength = 0.5f;
    scene.meshes[0].colors.assign(4, {0.5f, 1, 1, 1});
    EXPECT_NEAR(center_of(scene, front_camera()).occlusion, 0.6, 1e-12);
    EXPECT_EQ(center_of(scene, front_camera()).albedo, glm::dvec3(0.25, 0.25, 0.125));
    scene.materials[0].unlit = true;
    const SurfaceSample unlit = center_of(scene, front_camera());
    EXPECT_EQ(unlit.kind, SurfaceKind::unlit);
    EXPECT_EQ(unlit.emissive, glm::dvec3(0.25, 0.25, 0.125));
    scene.meshes[0].material = -1;
    EXPECT_EQ(center_of(scene, front_camera()).metallic, 1.0) << "glTF's default material";
}

}  // namespace
}  // namespace kilolux
