// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated_scenes.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <set>

#include "host/base/error.h"
#include "host/scene/light_generator_hash.h"
#include "host/scene/procedural_noise.h"

namespace kilolux {
namespace {

const Scene& scene_of(const std::string& name) {
    static std::map<std::string, Scene> made;
    if (made.count(name) == 0) made[name] = make_generated_scene(name);
    return made[name];
}

// Of all vertices in the world, rounded down to 0.1 mm off the round numbers that builders like, so
// that the last bit of a library's sine does not matter.
std::uint64_t fingerprint(const Scene& scene) {
    std::uint64_t hash = 0;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        for (const glm::vec3& p : mesh.positions) {
            const glm::dvec4 world = instance.world_from_object * glm::dvec4(p, 1.0);
            for (int i = 0; i < 3; ++i) {
                hash = mix64(hash + static_cast<std::uint64_t>(static_cast<std::int64_t>(
                                        std::floor(world[i] * 1e4 + 0.37))));
            }
        }
        for (const std::uint32_t index : mesh.indices) hash = mix64(hash + index);
    }
    return hash;
}

std::uint64_t image_fingerprint(const Scene& scene) {
    std::uint64_t hash = 0;
    for (const Image& image : scene.images) {
        for (const std::uint8_t byte : image.rgba) hash = mix64(hash + byte);
    }
    return hash;
}

class GeneratedScenes : public testing::TestWithParam<std::string> {};

TEST_P(GeneratedScenes, IsTheSameEveryTime) {
    const Scene again = make_generated_scene(GetParam());
    EXPECT_EQ(fingerprint(again), fingerprint(scene_of(GetParam())));
    EXPECT_EQ(image_fingerprint(again), image_fingerprint(scene_of(GetParam())));
}

TEST_P(GeneratedScenes, HasWhatEverySceneHas) {
    const Scene& scene = scene_of(GetParam());
    EXPECT_EQ(scene.name, GetParam());
    EXPECT_TRUE(scene.lights.empty());
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

TEST_P(GeneratedScenes, IndicesAreInRange) {
    const Scene& scene = scene_of(GetParam());
    std::set<int> used;
    for (const Instance& instance : scene.instances) {
        ASSERT_GE(instance.mesh, 0);
        ASSERT_LT(instance.mesh, static_cast<int>(scene.meshes.size()));
        used.insert(instance.mesh);
    }
    EXPECT_EQ(used.size(), scene.meshes.size()) << "a mesh that no instance uses";
    for (const Texture& texture : scene.textures) {
        ASSERT_GE(texture.image, 0);
        ASSERT_LT(texture.image, static_cast<int>(scene.images.size()));
    }
    for (const Image& image : scene.images) {
        EXPECT_EQ(image.rgba.size(), std::size_t{4} * image.width * image.height) << image.name;
    }
    for (const Material& material : scene.materials) {
        for (const TextureUse* use :
             {&material.base_color_texture, &material.metallic_roughness_texture,
              &material.normal_texture, &material.occlusion_texture, &material.emissive_texture}) {
            ASSERT_LT(use->texture, static_cast<int>(scene.textures.size())) << material.name;
        }
    }
    for (const Mesh& mesh : scene.meshes) {
        ASSERT_LT(mesh.material, static_cast<int>(scene.materials.size())) << mesh.name;
        ASSERT_EQ(mesh.indices.size() % 3, 0u) << mesh.name;
        ASSERT_FALSE(mesh.indices.empty()) << mesh.name;
        for (const std::uint32_t index : mesh.indices) {
            ASSERT_LT(index, mesh.positions.size()) << mesh.name;
        }
    }
}

TEST_P(GeneratedScenes, VerticesAreWhole) {
    for (const Mesh& mesh : scene_of(GetParam()).meshes) {
        const std::size_t count = mesh.positions.size();
        ASSERT_EQ(mesh.normals.size(), count) << mesh.name;
        for (const auto& uv : mesh.texcoords) ASSERT_TRUE(uv.empty() || uv.size() == count);
        ASSERT_TRUE(mesh.tangents.empty() || mesh.tangents.size() == count) << mesh.name;
        ASSERT_TRUE(mesh.colors.empty() || mesh.colors.size() == count) << mesh.name;
        for (std::size_t i = 0; i < count; ++i) {
            ASSERT_LT(glm::length(mesh.positions[i]), 1000.0f) << mesh.name << " " << i;
            ASSERT_NEAR(glm::length(mesh.normals[i]), 1.0f, 1e-5f) << mesh.name << " " << i;
        }
        for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
            const glm::vec3 t(mesh.tangents[i]);
            ASSERT_NEAR(glm::length(t), 1.0f, 1e-5f) << mesh.name << " " << i;
            ASSERT_NEAR(glm::dot(t, mesh.normals[i]), 0.0f, 1e-4f) << mesh.name << " " << i;
            ASSERT_EQ(std::abs(mesh.tangents[i].w), 1.0f) << mesh.name << " " << i;
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

TEST(Atrium, IsTheStoredBuilding) {
    EXPECT_EQ(fingerprint(scene_of("atrium")), 11900675417646898819u);
}

TEST(Atrium, IsAsLargeAsPromised) {
    const Scene& scene = scene_of("atrium");
    EXPECT_NEAR(static_cast<double>(triangle_count(scene)), 250e3, 25e3);
    EXPECT_GE(scene.instances.size(), 50u);
    EXPECT_LE(scene.instances.size(), 320u);
    EXPECT_EQ(scene.cameras.size(), 4u);
    const glm::dvec3 size = bounds(scene).size();
    EXPECT_NEAR(size.x, 31.0, 2.0);
    EXPECT_NEAR(size.y, 12.5, 1.0);
    EXPECT_NEAR(size.z, 18.5, 2.0);
}

TEST(Atrium, NeedsNoFourthPlane) {
    for (const Material& material : scene_of("atrium").materials) {
        EXPECT_EQ(material.metallic, 0.0f) << material.name;
        EXPECT_EQ(material.emissive, glm::vec3(0.0f)) << material.name;
        EXPECT_EQ(material.alpha_mode, AlphaMode::opaque) << material.name;
    }
}

TEST(Atrium, NormalMapsHaveTangents) {
    const Scene& scene = scene_of("atrium");
    std::set<std::string> mapped;
    for (const Mesh& mesh : scene.meshes) {
        const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
        EXPECT_EQ(material.normal_texture.present(), !mesh.tangents.empty()) << mesh.name;
        if (material.normal_texture.present()) mapped.insert(material.name);
    }
    EXPECT_EQ(mapped.count("brick") + mapped.count("tile"), 2u);
}

TEST(Atrium, SeedsDiffer) {
    const Scene other = make_generated_scene("atrium", 2);
    EXPECT_NE(fingerprint(other), fingerprint(scene_of("atrium")));
    EXPECT_NE(image_fingerprint(other), image_fingerprint(scene_of("atrium")));
    EXPECT_EQ(triangle_count(other) / 10000, triangle_count(scene_of("atrium")) / 10000);
}

// Where an image wraps, neighbours must be about as like as neighbours inside it.
TEST(Atrium, TexturesTile) {
    for (const Image& image : scene_of("atrium").images) {
        const auto row_step = [&](int y) {
            double sum = 0.0;
            for (int x = 0; x < image.width; ++x) {
                for (int c = 0; c < 3; ++c) {
                    const auto at = [&](int row) {
                        return image.rgba[static_cast<std::size_t>(
                            4 * ((row % image.height) * image.width + x) + c)];
                    };
                    sum += std::abs(at(y) - at(y + 1));
                }
            }
            return sum / image.width;
        };
        const auto column_step = [&](int x) {
            double sum = 0.0;
            for (int y = 0; y < image.height; ++y) {
                for (int c = 0; c < 3; ++c) {
                    const auto at = [&](int column) {
                        return image.rgba[static_cast<std::size_t>(
                            4 * (y * image.width + column % image.width) + c)];
                    };
                    sum += std::abs(at(x) - at(x + 1));
                }
            }
            return sum / image.height;
        };
        double largest_row = 0.0;
        double largest_column = 0.0;
        for (int i = 0; i + 1 < image.height; ++i) largest_row = std::max(largest_row, row_step(i));
        for (int i = 0; i + 1 < image.width; ++i) {
            largest_column = std::max(largest_column, column_step(i));
        }
        EXPECT_LE(row_step(image.height - 1), 1.3 * largest_row + 1.0) << image.name;
        EXPECT_LE(column_step(image.width - 1), 1.3 * largest_column + 1.0) << image.name;
    }
}

TEST(ProceduralNoise, HasItsPeriod) {
    for (int i = 0; i < 200; ++i) {
        const glm::dvec2 p(0.37 * i, 0.11 * i);
        EXPECT_NEAR(gradient_noise(p, {8, 5}, 3), gradient_noise(p + glm::dvec2(8, 5), {8, 5}, 3),
                    1e-9);
        const glm::dvec2 q = glm::fract(p);
        EXPECT_NEAR(fractal_noise(q, 4, 5, 9), fractal_noise(q + 1.0, 4, 5, 9), 1e-9);
        EXPECT_LE(std::abs(fractal_noise(q, 4, 5, 9)), 1.2);
    }
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

TEST(Corridor, IsLong) {
    EXPECT_NEAR(bounds(scene_of("corridor")).size().z, 500.0, 1e-3);
}

}  // namespace
}  // namespace kilolux
