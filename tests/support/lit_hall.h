// SPDX-License-Identifier: Apache-2.0
// A hall with many lights without a range, and files of scenes.
#pragma once

#include <cmath>
#include <filesystem>
#include <string>

#include "host/scene/export/export_scene.h"
#include "tests/support/box_scene.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {

/// A hall along z, 40 m x 8 m x 400 m, lit but for its last metres. `intensity`: of a light [cd].
inline Scene lit_hall(int count, float intensity) {
    Scene scene = box_scene({40.0, 8.0, 400.0}, true);
    for (int i = 0; i < count; ++i) {
        const double t = (i + 0.5) / count;
        SceneLight light;
        light.position = {36.0 * std::fmod(7.3 * i / 11.0, 1.0) - 18.0, std::fmod(i / 5.0, 1.0),
                          -200.0 + 370.0 * t};
        light.intensity = glm::vec3(intensity);
        scene.lights.push_back(light);
    }
    return scene;
}

/// Writes the scene as glTF; all files of it beside `file`.
inline void write_scene(const Scene& scene, const std::filesystem::path& file) {
    for (const ExportedFile& part : export_scene(scene, file).files) {
        write_text(file.parent_path() / part.name,
                   std::string(part.bytes.begin(), part.bytes.end()));
    }
}

}  // namespace kilolux
