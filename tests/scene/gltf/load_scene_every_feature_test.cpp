// SPDX-License-Identifier: Apache-2.0
// A generated file with everything that the loader supports: the checks of load_scene_files_test,
// on a scene that needs no downloads.
#include <gtest/gtest.h>

#include "tests/scene/export_scenes.h"
#include "tests/support/gltf_seeds.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

class LoadSceneEveryFeature : public testing::Test {
 protected:
    LoadSceneEveryFeature() {
        write_file(folder_.path() / "scene.glb", every_feature_file().glb());
        scene_ = load_scene(folder_.path() / "scene.glb");
    }

    const Mesh& mesh_of(std::size_t instance) const {
        return scene_.meshes.at(static_cast<std::size_t>(scene_.instances.at(instance).mesh));
    }

    TempFolder folder_;
    Scene scene_;
};

TEST_F(LoadSceneEveryFeature, GivesAllThatTheFileHolds) {
    EXPECT_EQ(scene_defect(scene_), "");
    // The quad skinned and morphed, and morphed alone; two ribbons of a strip and a fan; one quad
    // through each codec.
    EXPECT_EQ(scene_.meshes.size(), 6u);
    EXPECT_EQ(scene_.instances.size(), 8u);
    EXPECT_EQ(triangle_count(scene_), 16u);
    std::size_t vertices = 0;
    for (const Mesh& mesh : scene_.meshes) vertices += mesh.positions.size();
    EXPECT_EQ(vertices, 32u);  // 4 with normals, 6 where each corner is a vertex
    EXPECT_EQ(scene_.materials.size(), 2u);
    EXPECT_EQ(scene_.textures.size(), 3u);
    ASSERT_EQ(scene_.images.size(), 3u);
    std::vector<int> widths;
    for (const Image& image : scene_.images) widths.push_back(image.width);
    std::sort(widths.begin(), widths.end());
    EXPECT_EQ(widths, (std::vector<int>{1, 4, 8})) << "PNG, WebP, JPEG";
    EXPECT_FALSE(scene_.still_box.empty());
    EXPECT_EQ(scene_.lights.size(), 3u);
    EXPECT_EQ(scene_.cameras.size(), 3u) << "one below a hidden node";
}

TEST_F(LoadSceneEveryFeature, MeshesHaveWhatTheirMaterialsNeed) {
    for (const Mesh& mesh : scene_.meshes) {
        const bool bumpy = mesh.material == 0;
        EXPECT_EQ(mesh.tangents.empty(), !bumpy) << mesh.name;
        EXPECT_EQ(mesh.texcoords[0].empty(), !bumpy) << mesh.name;
        EXPECT_EQ(mesh.texcoords[1].empty(), !bumpy) << mesh.name;
    }
    EXPECT_EQ(mesh_of(0).colors.at(0), glm::vec4(200.0f / 255.0f));
    const Mesh& draco = mesh_of(7);
    EXPECT_EQ(draco.colors.at(0), glm::vec4(1, 0, 0, 1));
    for (const std::size_t quad : {6u, 7u}) {
        Box box;
        for (const glm::dvec3& p : world_positions(scene_, quad)) box.add(p);
        EXPECT_LT(glm::length(box.min) + glm::length(box.max - glm::dvec3(1, 1, 0)), 1e-3) << quad;
    }
    // Quantized positions to 4, scaled by a quarter.
    Box ribbon;
    for (const glm::dvec3& p : world_positions(scene_, 2)) ribbon.add(p);
    EXPECT_LT(glm::length(ribbon.max - glm::dvec3(1, 1, 0)), 1e-6);
    // The morph target lifts all vertices by half but the third, which its sparse part sets to 0.
    EXPECT_EQ(world_positions(scene_, 1).at(1).z, 0.5);
    EXPECT_EQ(world_positions(scene_, 1).at(2).z, 0.0);
}

TEST_F(LoadSceneEveryFeature, MaterialsHaveAllSlotsAndFactors) {
    const Material& all = scene_.materials.at(0);
    for (const TextureUse* use :
         {&all.base_color_texture, &all.metallic_roughness_texture, &all.normal_texture,
          &all.occlusion_texture, &all.emissive_texture, &all.specular_texture,
          &all.specular_color_texture, &all.clearcoat_texture, &all.clearcoat_roughness_texture,
          &all.clearcoat_normal_texture, &all.sheen_color_texture, &all.sheen_roughness_texture,
          &all.anisotropy_texture, &all.transmission_texture, &all.thickness_texture}) {
        EXPECT_TRUE(use->present());
    }
    EXPECT_EQ(all.base_color, glm::vec4(0.5f, 0.25f, 1.0f, 0.75f));
    EXPECT_EQ(all.metallic, 0.5f);
    EXPECT_EQ(all.roughness, 0.25f);
    EXPECT_EQ(all.metallic_roughness_texture.uv_set, 1);
    EXPECT_EQ(all.occlusion_strength, 0.5f);
    EXPECT_EQ(all.emissive, glm::vec3(4, 2, 0));
    EXPECT_EQ(all.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(all.alpha_cutoff, 0.25f);
    EXPECT_TRUE(all.double_sided);
    EXPECT_EQ(all.ior, 1.25f);
    EXPECT_EQ(all.specular, 0.5f);
    EXPECT_EQ(all.specular_color, glm::vec3(1.0f, 0.5f, 2.0f));
    EXPECT_EQ(all.specular_texture.uv_from_texcoord[2].x, 0.5f);
    EXPECT_EQ(all.specular_color_texture.uv_set, 1);
    EXPECT_EQ(all.clearcoat, 0.75f);
    EXPECT_EQ(all.clearcoat_roughness, 0.125f);
    EXPECT_EQ(all.clearcoat_normal_scale, 0.5f);
    EXPECT_EQ(all.clearcoat_roughness_texture.uv_set, 1);
    EXPECT_EQ(all.sheen_color, glm::vec3(0.5f, 0.25f, 1.0f));
    EXPECT_EQ(all.sheen_roughness, 0.375f);
    EXPECT_EQ(all.sheen_color_texture.uv_set, 1);
    EXPECT_EQ(all.anisotropy_strength, 0.75f);
    EXPECT_EQ(all.anisotropy_rotation, -4.5f);
    EXPECT_EQ(all.thickness, 0.25f);
    EXPECT_EQ(all.thickness_texture.uv_set, 1);
    EXPECT_EQ(all.attenuation_distance, 0.5f);
    EXPECT_EQ(all.attenuation_color, glm::vec3(0.5f, 0.25f, 1.0f));
    EXPECT_NE(all.normal_texture.uv_from_texcoord[0].y, 0.0f) << "rotated";
    const Sampler& sampler =
        scene_.textures.at(static_cast<std::size_t>(all.base_color_texture.texture)).sampler;
    EXPECT_EQ(sampler.wrap_s, Wrap::clamp);
    EXPECT_EQ(sampler.magnify, Filter::nearest);
    EXPECT_EQ(sampler.between_mipmaps, Filter::nearest);
    EXPECT_TRUE(scene_.materials.at(1).unlit);
    EXPECT_EQ(scene_.materials.at(1).alpha_mode, AlphaMode::blend);
}

TEST_F(LoadSceneEveryFeature, LightsAndCamerasStandAtTheirNodes) {
    const auto& lights = scene_.lights;
    EXPECT_EQ(lights.at(0).type, LightType::point);
    EXPECT_EQ(lights.at(0).intensity, glm::vec3(30.0f));
    EXPECT_EQ(lights.at(0).range, 0.0f);
    EXPECT_EQ(lights.at(1).type, LightType::spot);
    EXPECT_EQ(lights.at(1).position, glm::dvec3(1, 2, 0));
    EXPECT_EQ(lights.at(1).intensity, glm::vec3(1.0f, 0.5f, 0.0f));
    EXPECT_EQ(lights.at(1).range, 3.0f);
    EXPECT_EQ(lights.at(1).outer_cone, 1.0f);
    EXPECT_EQ(lights.at(2).type, LightType::directional);
    EXPECT_EQ(lights.at(2).direction, glm::dvec3(0, 0, -1));
    EXPECT_FALSE(scene_.cameras.at(0).orthographic);
    EXPECT_TRUE(scene_.cameras.at(1).orthographic);
    EXPECT_EQ(scene_.cameras.at(1).aspect, 2.0);
    EXPECT_EQ(glm::dvec3(scene_.cameras.at(1).world_from_camera[3]), glm::dvec3(1, 2, 0));
}

TEST_F(LoadSceneEveryFeature, MovesWithTime) {
    LoadOptions options;
    options.time = 1.5;
    const Scene later = load_scene(folder_.path() / "scene.glb", options);
    // The joint and its child move along x by 1.5; the ribbons do not.
    for (const std::size_t moving : {0u, 1u}) {
        EXPECT_NEAR(world_positions(later, moving)[0].x - world_positions(scene_, moving)[0].x, 1.5,
                    1e-6);
    }
    EXPECT_EQ(world_positions(later, 2), world_positions(scene_, 2));
    EXPECT_EQ(later.still_box, bounds(later)) << "what a camera of no file frames";
}

TEST_F(LoadSceneEveryFeature, IsTheSameSceneFromFilesBesideIt) {
    testing::internal::CaptureStderr();
    const Scene split = load_scene(write_with_files(every_feature_file(), folder_.path()));
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "nothing is left out";
    EXPECT_EQ(scene_difference(scene_, split), "");
}

}  // namespace
}  // namespace kilolux
