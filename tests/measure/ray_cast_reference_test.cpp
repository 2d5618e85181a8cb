// SPDX-License-Identifier: Apache-2.0
#include "host/measure/ray_cast_reference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/measure/camera_rays.h"
#include "host/measure/reference.h"

namespace kilolux {
namespace {

constexpr double kRounding = 4e-15;  // a few operations in double

// A quad in the plane z = 0, counter-clockwise from +Z, from (-size, -size) to (size, size).
Mesh quad(float size) {
    Mesh mesh;
    mesh.positions = {{-size, -size, 0}, {size, -size, 0}, {size, size, 0}, {-size, size, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.material = 0;
    return mesh;
}

Scene quad_scene(float size = 10.0f) {
    Scene scene;
    scene.meshes.push_back(quad(size));
    scene.instances.push_back({0, glm::dmat4(1.0)});
    Material material;
    material.base_color = {0.5f, 0.25f, 0.125f, 1.0f};
    material.roughness = 0.75f;
    material.metallic = 0.25f;
    material.emissive = {1, 2, 3};
    scene.materials.push_back(material);
    return scene;
}

SurfaceSample center_of(const Scene& scene, const Camera& camera,
                        const RayCastOptions& options = {}) {
    return RayCaster(scene).cast(camera, 3, 3, options).at(1, 1);
}

Camera front_camera(double distance = 5.0) {
    return look_at({0, 0, distance}, {0, 0, 0}, {0, 1, 0}, 0.9);
}

TEST(RayCast, FlatUntexturedSurfaceIsExact) {
    const Scene scene = quad_scene();
    const Camera camera = look_at({1, 2, 5}, {0.5, 0.25, 0}, {0.1, 1, 0}, 0.9);
    const SurfaceSamples samples = RayCaster(scene).cast(camera, 33, 17);
    for (const SurfaceSample& s : samples.pixels) {
        ASSERT_EQ(s.kind, SurfaceKind::lit);
        const glm::dvec3 world = camera.position + camera.world_from_view * s.position;
        EXPECT_NEAR(world.z, 0.0, kRounding * 10);
        const glm::dvec3 normal = camera.world_from_view * s.normal;
        EXPECT_NEAR(normal.z, 1.0, kRounding);
        EXPECT_EQ(s.albedo, glm::dvec3(0.5, 0.25, 0.125));
        EXPECT_EQ(s.emissive, glm::dvec3(1, 2, 3));
        EXPECT_EQ(s.roughness, 0.75);
        EXPECT_EQ(s.metallic, 0.25);
        EXPECT_EQ(s.occlusion, 1.0);
    }
}

// Positions, put through the camera's own projection, fall on the pixel's sample point.
TEST(RayCast, ProjectsBackToThePixelForEveryCamera) {
    const Scene scene = quad_scene(100.0f);
    for (const bool orthographic : {false, true}) {
        for (const double shift : {0.0, 0.4}) {
            Camera camera = look_at({3, -2, 4}, {0, 0, 0}, {0, 1, 0.2}, 1.0);
            camera.orthographic = orthographic;
            camera.y_extent = 3.0;
            if (orthographic) {
                camera.z_near = -20.0;
                camera.z_far = 50.0;
            }
            camera.shear = {shift, -0.5 * shift};
            camera.jitter = {shift, -0.25};
            const SurfaceSamples samples = RayCaster(scene).cast(camera, 31, 20);
            const glm::dmat4 clip = clip_from_view(camera, 31, 20);
            for (int y = 0; y < 20; ++y) {
                for (int x = 0; x < 31; ++x) {
                    const SurfaceSample& s = samples.at(x, y);
                    if (s.kind == SurfaceKind::background) continue;
                    const glm::dvec4 p = clip * glm::dvec4(s.position, 1.0);
                    // clip_from_view moves the picture by the jitter: samples land on pixel
                    // centres.
                    EXPECT_NEAR((p.x / p.w + 1) / 2 * 31, x + 0.5, 1e-12) << orthographic << shift;
                    EXPECT_NEAR((1 - p.y / p.w) / 2 * 20, y + 0.5, 1e-12) << orthographic << shift;
                }
            }
            EXPECT_EQ(samples.at(15, 10).kind, SurfaceKind::lit);
        }
    }
}

TEST(RayCast, NearAndFarCut) {
    const Scene scene = quad_scene();
    Camera camera = front_camera();
    EXPECT_EQ(center_of(scene, camera).kind, SurfaceKind::lit);
    camera.z_near = 5.001;
    EXPECT_EQ(center_of(scene, camera).kind, SurfaceKind::background);
    camera.z_near = 0.1;
    camera.z_far = 4.999;
    EXPECT_EQ(center_of(scene, camera).kind, SurfaceKind::background);
}

TEST(RayCast, BackFacesAreSeenOnlyWhenDoubleSided) {
    Scene scene = quad_scene();
    const Camera behind = look_at({0, 0, -5}, {0, 0, 0}, {0, 1, 0}, 0.9);
    EXPECT_EQ(center_of(scene, behind).kind, SurfaceKind::background);
    scene.materials[0].double_sided = true;
    EXPECT_NEAR(center_of(scene, behind).normal.z, 1.0, kRounding) << "turned to the camera";
}

TEST(RayCast, MirroringTransformsKeepTheFrontInFront) {
    Scene scene = quad_scene();
    scene.instances[0].world_from_object[0][0] = -1.0;
    EXPECT_EQ(center_of(scene, front_camera()).kind, SurfaceKind::lit);
    EXPECT_NEAR(center_of(scene, front_camera()).normal.z, 1.0, kRounding);
    scene.meshes[0].normals.clear();
    EXPECT_NEAR(center_of(scene, front_camera()).normal.z, 1.0, kRounding);
    scene.instances[0].world_from_object[2][2] = -1.0;
    EXPECT_EQ(center_of(scene, front_camera()).kind, SurfaceKind::background) << "turned away";
}

TEST(RayCast, NormalsFollowTheInverseTranspose) {
    Scene scene = quad_scene();
    scene.meshes[0].normals.assign(4, glm::normalize(glm::vec3(1, 0, 1)));
    scene.instances[0].world_from_object[0][0] = 4.0;
    const glm::dvec3 normal = center_of(scene, front_camera()).normal;
    EXPECT_NEAR(normal.x / normal.z, 0.25, 1e-7);
    EXPECT_NEAR(glm::length(normal), 1.0, kRounding);
}

TEST(RayCast, NormalsAreInterpolatedAndMadeUnit) {
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
TEST(RayCast, TextureCoordinatesAreCorrectInPerspective) {
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
TEST(RayCast, MipLevelFollowsTheFootprint) {
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

TEST(RayCast, AlphaMaskCutsHoles) {
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
    const auto depths = [&](double blend_cutoff) {
        const SurfaceSamples s =
            RayCaster(scene).cast(front_camera(), 2, 1, {.blend_cutoff = blend_cutoff});
        const auto depth = [](const SurfaceSample& p) {
            return p.kind == SurfaceKind::background ? 0.0 : -p.position.z;
        };
        return glm::dvec2(depth(s.at(0, 0)), depth(s.at(1, 0)));
    };
    EXPECT_NEAR(depths(0).x, 5.0, 1e-12) << "opaque: alpha is not looked at";
    scene.materials[0].alpha_mode = AlphaMode::mask;
    EXPECT_EQ(depths(0).x, 0.0) << "both quads have the hole";
    EXPECT_NEAR(depths(0).y, 5.0, 1e-12);
    scene.materials[0].alpha_cutoff = 0.0f;
    EXPECT_NEAR(depths(0).x, 5.0, 1e-12);
    scene.materials[0].alpha_mode = AlphaMode::blend;
    EXPECT_NEAR(depths(0).x, 5.0, 1e-12);
    EXPECT_EQ(depths(0.5).x, 0.0);
}

TEST(RayCast, NormalMapTiltsInTheTangentFrame) {
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

TEST(RayCast, OcclusionVertexColorsUnlitAndDefaults) {
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

TEST(RayCast, ShadesLikeTheFormula) {
    Scene scene = quad_scene();
    scene.materials[0].emissive = {0, 0, 0};
    SceneLight light;
    light.position = {0, 0, 2};
    light.intensity = {8, 8, 8};
    light.range = 4.0f;
    const Camera camera = front_camera();
    const SurfaceSamples samples = RayCaster(scene).cast(camera, 3, 3);
    const ReferencePicture picture =
        shade_reference(samples, reference_lights(std::vector{light}, camera), {});
    const double expected = 0.5 / std::acos(-1.0) * 8 * (1 - 1.0 / 16) / 4;
    EXPECT_NEAR(picture.radiance.rgb[3 * 4], expected, 1e-14);
}

TEST(RayCast, EmptyScenesAreBackground) {
    for (const SurfaceSample& s : RayCaster(Scene{}).cast(front_camera(), 4, 4).pixels) {
        EXPECT_EQ(s.kind, SurfaceKind::background);
    }
}

TEST(CameraRays, StepsAreNeighboursDifferences) {
    Camera camera = front_camera();
    for (const bool orthographic : {false, true}) {
        camera.orthographic = orthographic;
        const PixelRay at = pixel_ray(camera, 7, 5, 2, 3);
        const PixelRay right = pixel_ray(camera, 7, 5, 3, 3);
        const PixelRay down = pixel_ray(camera, 7, 5, 2, 4);
        EXPECT_LT(glm::distance(at.origin + at.origin_dx, right.origin), 1e-15);
        EXPECT_LT(glm::distance(at.direction + at.direction_dx, right.direction), 1e-15);
        EXPECT_LT(glm::distance(at.origin + at.origin_dy, down.origin), 1e-15);
        EXPECT_LT(glm::distance(at.direction + at.direction_dy, down.direction), 1e-15);
    }
}

}  // namespace
}  // namespace kilolux
