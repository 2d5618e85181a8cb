// SPDX-License-Identifier: Apache-2.0
// Scenes of other authors, from the folder beside this one where it exists. Expected contents are
// from their JSON and READMEs.
#include <gtest/gtest.h>

#include <set>

#include "host/scene/gltf/load_scene.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/paths.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

fs::path scenes() { return fs::path(source_root()) / ".." / "shared" / "scenes"; }

// Names below `folder` of its glTF files.
std::set<std::string> gltf_files(const fs::path& folder) {
    std::set<std::string> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
        const std::string extension = entry.path().extension().string();
        if (extension == ".gltf" || extension == ".glb") {
            files.insert(fs::relative(entry.path(), folder).string());
        }
    }
    return files;
}

std::size_t vertex_count(const Scene& scene) {
    std::size_t count = 0;
    for (const Mesh& mesh : scene.meshes) count += mesh.positions.size();
    return count;
}

void expect_box(const Scene& scene, const Box& expected, double tolerance) {
    const Box box = bounds(scene);
    EXPECT_LT(glm::length(box.min - expected.min), tolerance) << box.min.x << " " << box.min.y;
    EXPECT_LT(glm::length(box.max - expected.max), tolerance) << box.max.x << " " << box.max.y;
}

TEST(LoadSceneFiles, ReadsSponza) {
    const fs::path file = scenes() / "sponza" / "Sponza.gltf";
    if (!fs::exists(file)) GTEST_SKIP() << file << " is not there";
    const Scene scene = load_scene(file);
    EXPECT_EQ(scene_defect(scene), "");
    EXPECT_EQ(triangle_count(scene), 262267u);
    // Mirrored texture coordinates need tangents of both hands: a few vertices are doubled.
    EXPECT_GE(vertex_count(scene), 192812u);
    EXPECT_LT(vertex_count(scene), 193000u);
    EXPECT_EQ(scene.meshes.size(), 103u);
    EXPECT_EQ(scene.instances.size(), 103u);
    EXPECT_EQ(scene.textures.size(), 69u);
    EXPECT_EQ(scene.images.size(), 69u);
    ASSERT_EQ(scene.materials.size(), 25u);
    std::size_t masked = 0;
    for (const Material& material : scene.materials) {
        const bool mask = material.alpha_mode == AlphaMode::mask;
        EXPECT_EQ(material.double_sided, mask) << material.name;
        EXPECT_NE(material.alpha_mode, AlphaMode::blend) << material.name;
        masked += mask ? 1 : 0;
    }
    EXPECT_EQ(masked, 3u);
    for (const Mesh& mesh : scene.meshes) {
        const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
        EXPECT_EQ(mesh.tangents.empty(), !material.normal_texture.present());
        EXPECT_FALSE(mesh.texcoords[0].empty());
    }
    EXPECT_DOUBLE_EQ(scene.instances[0].world_from_object[1][1], 0.00800000037997961);
    expect_box(scene, {{-15.37, -1.01, -9.46}, {14.40, 11.44, 8.84}}, 0.01);
}

TEST(LoadSceneFiles, ReadsTheHelmet) {
    const fs::path file = scenes() / "helmet" / "DamagedHelmet.glb";
    if (!fs::exists(file)) GTEST_SKIP() << file << " is not there";
    const Scene scene = load_scene(file);
    EXPECT_EQ(scene_defect(scene), "");
    EXPECT_EQ(triangle_count(scene), 15452u);
    EXPECT_EQ(vertex_count(scene), 14556u);
    ASSERT_EQ(scene.images.size(), 5u);
    for (const Image& image : scene.images) EXPECT_EQ(image.width, 2048);
    const Material& material = scene.materials.at(0);
    for (const TextureUse* use :
         {&material.base_color_texture, &material.metallic_roughness_texture,
          &material.normal_texture, &material.occlusion_texture, &material.emissive_texture}) {
        EXPECT_TRUE(use->present());
    }
    EXPECT_EQ(material.emissive, glm::vec3(1.0f));
    EXPECT_EQ(scene.meshes.at(0).tangents.size(), 14556u);
}

TEST(LoadSceneFiles, ReadsAllSmallScenes) {
    const fs::path folder = scenes() / "small";
    if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
    struct Facts {
        const char* file;
        std::size_t triangles, vertices, meshes, instances, materials, images;
        glm::dvec3 corner;  // of the box, which is centred on the origin
    };
    const glm::dvec3 half(0.5);
    const std::vector<Facts> all = {
        {"Box.glb", 12, 24, 1, 1, 1, 0, half},
        {"BoxMeshopt.glb", 12, 24, 1, 1, 1, 0, half},
        {"BoxTextured/BoxTextured.gltf", 12, 24, 1, 1, 1, 1, half},
        {"BoxVertexColors.glb", 12, 24, 1, 1, 1, 0, half},
        {"CubeImageUriSpaces/CubeImageUriMultipleSpaces.gltf", 12, 24, 1, 1, 1, 1, half},
        {"CubeImageUriSpaces/CubeImageUriSpaces.gltf", 12, 24, 1, 1, 1, 1, half},
        // 2390 triangles in six meshes, one of them in two nodes.
        {"ShapeCollection.glb", 3542, 4872, 6, 7, 0, 0, {7.25, 1.0, 1.25}},
        // Without normals: flat ones, so each corner is a vertex of its own.
        {"TwoCubes.glb", 24, 72, 2, 2, 2, 0, {3.0, 1.0, 1.0}}};
    std::set<std::string> known;
    for (const Facts& facts : all) {
        SCOPED_TRACE(facts.file);
        known.insert(facts.file);
        const Scene scene = load_scene(folder / facts.file);
        EXPECT_EQ(scene_defect(scene), "");
        EXPECT_EQ(triangle_count(scene), facts.triangles);
        EXPECT_EQ(vertex_count(scene), facts.vertices);
        EXPECT_EQ(scene.meshes.size(), facts.meshes);
        EXPECT_EQ(scene.instances.size(), facts.instances);
        EXPECT_EQ(scene.materials.size(), facts.materials);
        EXPECT_EQ(scene.images.size(), facts.images);
        expect_box(scene, {-facts.corner, facts.corner}, 1e-3);
    }
    EXPECT_EQ(known, gltf_files(folder)) << "a file that this test does not know";
}

TEST(LoadSceneFiles, ReadsTheSmallScenesContents) {
    const fs::path folder = scenes() / "small";
    if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
    const Scene textured = load_scene(folder / "BoxTextured" / "BoxTextured.gltf");
    EXPECT_EQ(textured.images.at(0).width, 256);
    EXPECT_TRUE(textured.materials.at(0).base_color_texture.present());
    const Scene coloured = load_scene(folder / "BoxVertexColors.glb");
    EXPECT_EQ(coloured.meshes.at(0).colors.size(), 24u);
    for (const char* name : {"CubeImageUriMultipleSpaces.gltf", "CubeImageUriSpaces.gltf"}) {
        const Scene cube = load_scene(folder / "CubeImageUriSpaces" / name);
        EXPECT_EQ(cube.images.at(0).rgba.size(), 4u * 4u) << name;
    }
    // The same box, once through the meshopt codec and quantization.
    const Scene box = load_scene(folder / "Box.glb");
    const Scene packed = load_scene(folder / "BoxMeshopt.glb");
    EXPECT_EQ(packed.materials.at(0).base_color, box.materials.at(0).base_color);
    EXPECT_EQ(world_positions(packed).size(), world_positions(box).size());
}

TEST(LoadSceneFiles, LoadsOrNamesAllMalformedScenes) {
    const fs::path folder = scenes() / "malformed";
    if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
    struct Case {
        const char* file;
        const char* message;        // after the file's name; "": the defect is harmless
        std::size_t triangles = 0;  // of those that load
    };
    const std::vector<Case> all = {
        {"integer-out-of-bounds.gltf", "bufferViews[0].byteLength is 1e+300, must be an integer"},
        {"invalid-buffer-index.gltf", "bufferViews[1].buffer is 1, must be an index into the 1 "},
        {"invalid-buffer-view-index.gltf", "bufferViews[0].buffer is 0, must be an index into the"},
        {"invalid-primitive-indices.gltf", "bufferViews[0].buffer is 0, must be an index into the"},
        {"issue-416.gltf", "asset.version is '', must be 2.0"},
        {"issue-492.glb", "", 0},  // skins and nodes alone
        {"unassigned-skeleton.gltf", "", 8},
        {"zero-sized-bin-chunk-issue-440.glb", "", 1}};
    std::set<std::string> known;
    for (const Case& c : all) {
        SCOPED_TRACE(c.file);
        known.insert(c.file);
        const fs::path file = folder / c.file;
        const std::string error = load_error(file);
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
        if (std::string(c.message).empty()) {
            ASSERT_EQ(error, "");
            const Scene scene = load_scene(file);
            EXPECT_EQ(scene_defect(scene), "");
            EXPECT_EQ(triangle_count(scene), c.triangles);
        } else {
            EXPECT_TRUE(error.starts_with(file.string() + ": " + c.message)) << error;
        }
    }
    EXPECT_EQ(known, gltf_files(folder)) << "a file that this test does not know";
}

}  // namespace
}  // namespace kilolux
