// SPDX-License-Identifier: Apache-2.0
// Exported files are valid by the Khronos validator, which npm installs.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <sstream>

#include "host/scene/generated/scenes.h"
#include "host/scene/lights/light_generator.h"
#include "tests/scene/export_scenes.h"
#include "tests/support/gltf_seeds.h"
#include "tests/support/messages.h"
#include "tests/support/npm.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

Scene sheared_scene() {
    Scene scene = scene_of_everything();
    glm::dmat4 shear(1.0);
    shear[1].x = 0.9;
    scene.instances.push_back({0, shear});
    const float c = std::cos(0.7f), s = std::sin(0.7f);
    scene.materials[0].base_color_texture.uv_from_texcoord =
        glm::mat3(glm::vec3(c, -s, 0.0f), glm::vec3(s, c, 0.0f), glm::vec3(0.1f, 0.2f, 1.0f));
    scene.cameras[1].z_near = -1.0;
    return scene;
}

Scene lit(const std::string& name) {
    Scene scene = make_generated_scene(name);
    LightOptions lights;
    lights.count = 64;
    scene.lights = generate_lights(lights, scene, 0.5);
    return scene;
}

TEST(ExportSceneValidator, FindsNoErrorAndNoWarning) {
    std::string why;
    const fs::path validator =
        install_npm("gltf_validator", "gltf-validator", {"node", "npm"}, why);
    if (validator.empty()) GTEST_SKIP() << why;
    const TempFolder folder;
    const fs::path script = fs::path(source_root()) / "tests" / "gltf_validator" / "validate.js";
    std::vector<std::string> words = {"/usr/bin/env", "node", script.string(), validator.string()};
    int count = 0;
    const auto add = [&](const Scene& scene, const std::string& name) {
        write_export(export_scene(scene, folder.path() / name), folder.path());
        words.push_back((folder.path() / name).string());
        ++count;
    };
    add(scene_of_everything(), "everything.glb");
    add(scene_of_everything(), "every thing.gltf");
    add(sheared_scene(), "sheared.gltf");
    add(lit("corridor"), "corridor.glb");
    add(lit("atrium"), "atrium.glb");
    write_file(folder.path() / "features.glb", every_feature_file().glb());
    add(load_scene(folder.path() / "features.glb"), "features.glb");
    write_file(folder.path() / "converted.glb", converted_features_file().glb());
    add(load_scene(folder.path() / "converted.glb"), "converted.glb");
    add({}, "empty.glb");
    const ChildResult out = run_child(words);
    ASSERT_EQ(out.code, 0) << out.err;
    int validated = 0;
    std::istringstream lines(out.out);
    for (std::string line; std::getline(lines, line);) {
        const bool is_fault = line.starts_with("0 ") || line.starts_with("1 ");
        // A material with everything is double-sided glass with a volume, too.
        EXPECT_FALSE(is_fault && !contains(line, "KHR_MATERIALS_VOLUME_DOUBLE_SIDED")) << line;
        if (line.starts_with("validated ")) ++validated;
    }
    EXPECT_EQ(validated, count) << out.out;
}

}  // namespace
}  // namespace kilolux
