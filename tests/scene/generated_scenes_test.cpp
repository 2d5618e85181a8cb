// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "host/base/error.h"
#include "tests/scene/generated_scenes_fixture.h"
#include "tests/support/gltf_builder.h"

namespace kilolux {
namespace {

class GeneratedScenes : public testing::TestWithParam<std::string> {};

TEST_P(GeneratedScenes, IsTheSameEveryTime) {
    const Scene again = make_generated_scene(GetParam());
    EXPECT_EQ(fingerprint(again), fingerprint(scene_of(GetParam())));
    EXPECT_EQ(image_fingerprint(again), image_fingerprint(scene_of(GetParam())));
}

TEST_P(GeneratedScenes, HasWhatEverySceneHas) {
    const Scene& scene = scene_of(GetParam());
    EXPECT_EQ(scene.name, GetParam());
    EXPECT_EQ(scene.lights.empty(), GetParam() != "lanterns");
    ASSERT_FALSE(scene.cameras.empty());
    ASSERT_FALSE(scene.light_box.empty());
    const Box all = bounds(scene);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(scene.light_box.min[axis], all.min[axis] - 0.5) << "axis " << axis;
        EXPECT_LE(scene.light_box.max[axis], all.max[axis] + 2.0) << "axis " << axis;
    }
    for (const SceneCamera& camera : scene.cameras) {
        const glm::dmat3 axes(camera.world_from_camera);
        EXPECT_NEAR(glm::determinant(axes), 1.0, 1e-12) << camera.name;
        EXPECT_GT(camera.z_near, 0.0) << camera.name;
    }
}

TEST_P(GeneratedScenes, IsWhole) {
    const Scene& scene = scene_of(GetParam());
    EXPECT_EQ(scene_defect(scene), "");
    std::set<int> used;
    for (const Instance& instance : scene.instances) used.insert(instance.mesh);
    EXPECT_EQ(used.size(), scene.meshes.size()) << "a mesh that no instance uses";
    for (const Material& material : scene.materials) {
        for (const TextureUse* use :
             {&material.base_color_texture, &material.metallic_roughness_texture,
              &material.normal_texture, &material.occlusion_texture, &material.emissive_texture}) {
            ASSERT_LT(use->texture, static_cast<int>(scene.textures.size())) << material.name;
        }
    }
    for (const Mesh& mesh : scene.meshes) {
        for (const glm::vec3& p : mesh.positions) ASSERT_LT(glm::length(p), 1000.0f) << mesh.name;
        for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
            const float cosine = glm::dot(glm::vec3(mesh.tangents[i]), mesh.normals[i]);
            ASSERT_NEAR(cosine, 0.0f, 1e-4f) << mesh.name << " " << i;
        }
    }
}

TEST_P(GeneratedScenes, FacesAreWoundAboutTheirNormals) {
    for (const Mesh& mesh : scene_of(GetParam()).meshes) {
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const std::uint32_t* v = &mesh.indices[i];
            const glm::vec3 n = glm::cross(mesh.positions[v[1]] - mesh.positions[v[0]],
                                           mesh.positions[v[2]] - mesh.positions[v[0]]);
            ASSERT_GT(glm::length(n), 1e-10f) << mesh.name << " triangle " << i / 3;
            const glm::vec3 sum = mesh.normals[v[0]] + mesh.normals[v[1]] + mesh.normals[v[2]];
            ASSERT_GT(glm::dot(n, sum), 0.0f) << mesh.name << " triangle " << i / 3;
        }
    }
}

// cross(normal, tangent) * w is where v shrinks: up in the image, glTF's +Y of a normal map.
TEST_P(GeneratedScenes, TangentsFollowTheTexture) {
    for (const Mesh& mesh : scene_of(GetParam()).meshes) {
        if (mesh.tangents.empty()) continue;
        std::size_t against = 0;
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const std::uint32_t* v = &mesh.indices[i];
            const glm::vec3 e1 = mesh.positions[v[1]] - mesh.positions[v[0]];
            const glm::vec3 e2 = mesh.positions[v[2]] - mesh.positions[v[0]];
            const glm::vec2 d1 = mesh.texcoords[0][v[1]] - mesh.texcoords[0][v[0]];
            const glm::vec2 d2 = mesh.texcoords[0][v[2]] - mesh.texcoords[0][v[0]];
            const float area = d1.x * d2.y - d2.x * d1.y;
            const glm::vec3 along_u = (e1 * d2.y - e2 * d1.y) * (area < 0.0f ? -1.0f : 1.0f);
            const glm::vec3 along_v = (e2 * d1.x - e1 * d2.x) * (area < 0.0f ? -1.0f : 1.0f);
            const glm::vec3 t(mesh.tangents[v[0]]);
            const glm::vec3 b = glm::cross(mesh.normals[v[0]], t) * mesh.tangents[v[0]].w;
            against += !(glm::dot(t, along_u) > 0.0f && glm::dot(b, along_v) < 0.0f);
        }
        EXPECT_EQ(against, 0u) << mesh.name << " of " << mesh.indices.size() / 3;
    }
}

INSTANTIATE_TEST_SUITE_P(All, GeneratedScenes, testing::ValuesIn(generated_scene_names()));

TEST(GeneratedScenesList, AtriumIsTheDefault) {
    EXPECT_EQ(generated_scene_names().front(), "atrium");
    EXPECT_TRUE(is_generated_scene("grid"));
    EXPECT_FALSE(is_generated_scene("Atrium"));
    EXPECT_FALSE(is_generated_scene(""));
    EXPECT_THROW(make_generated_scene("sponza.gltf"), Error);
}

TEST(Grid, HasEveryMaterialFeature) {
    const Scene& scene = scene_of("grid");
    std::set<std::string> found;
    const auto note = [&](bool holds, const char* what) {
        if (holds) found.insert(what);
    };
    for (const Material& m : scene.materials) {
        note(m.base_color_texture.present(), "base colour texture");
        note(m.normal_texture.present(), "normal map");
        note(m.metallic > 0.0f, "metallic");
        note(m.metallic_roughness_texture.present(), "metallic-roughness texture");
        note(m.emissive != glm::vec3(0.0f), "emissive");
        note(m.emissive_texture.present(), "emissive texture");
        note(m.occlusion_texture.present(), "occlusion texture");
        note(m.alpha_mode == AlphaMode::mask, "alpha mask");
        note(m.double_sided, "double-sided");
        note(m.base_color_texture.uv_set == 1, "second uv set");
        note(m.base_color_texture.uv_from_texcoord != glm::mat3(1.0f), "texture transform");
        note(m.unlit, "unlit");
        note(m.ior != 1.5f, "ior");
    }
    for (const Mesh& mesh : scene.meshes) note(!mesh.colors.empty(), "vertex colours");
    for (const Instance& instance : scene.instances) {
        const glm::dmat3 turn(instance.world_from_object);
        note(glm::determinant(turn) < 0.0, "mirrored");
        note(std::abs(glm::length(turn[0]) - glm::length(turn[1])) > 0.1, "unevenly scaled");
    }
    for (const SceneCamera& camera : scene.cameras) {
        note(camera.orthographic, "orthographic");
        note(!camera.orthographic, "perspective");
    }
    EXPECT_EQ(found.size(), 18u) << testing::PrintToString(found);
    EXPECT_LT(triangle_count(scene), 8000u);
}

TEST(Plain, NeedsNothing) {
    const Scene& scene = scene_of("plain");
    EXPECT_TRUE(scene.images.empty());
    for (const Material& m : scene.materials) {
        EXPECT_EQ(m.metallic, 0.0f);
        EXPECT_FALSE(m.double_sided);
    }
    for (const Mesh& mesh : scene.meshes) {
        EXPECT_TRUE(mesh.tangents.empty() && mesh.colors.empty() && mesh.texcoords[0].empty());
    }
}

TEST(Corridor, IsLong) { EXPECT_NEAR(bounds(scene_of("corridor")).size().z, 500.0, 1e-3); }

}  // namespace
}  // namespace kilolux
