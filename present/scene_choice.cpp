// SPDX-License-Identifier: Apache-2.0
#include "present/scene_choice.h"

#include <filesystem>

#include "host/base/error.h"
#include "host/scene/generated_scenes.h"
#include "host/scene/load_scene.h"
#include "present/suggest.h"

namespace kilolux {

Scene open_scene(const std::string& name_or_file, double time, bool allow_outside_paths) {
    if (is_generated_scene(name_or_file)) return make_generated_scene(name_or_file);
    const std::filesystem::path file(name_or_file);
    if (std::filesystem::is_directory(file)) {
        throw Error(name_or_file + ": is a folder, not a scene file");
    }
    const bool named_as_file = file.has_extension() || file.has_parent_path();
    if (!std::filesystem::exists(file) && !named_as_file) {
        const std::vector<std::string> names = generated_scene_names();
        throw UsageError("scene '" + name_or_file + "' is no file, and none of " + joined(names) +
                         did_you_mean(name_or_file, names));
    }
    if (!std::filesystem::exists(file)) throw Error(name_or_file + ": no such scene file");
    LoadOptions options;
    options.time = time;
    options.allow_outside_paths = allow_outside_paths;
    return load_scene(file, options);
}

Scene open_scene(const SharedOptions& options) {
    return open_scene(options.scene, options.time, options.allow_outside_paths);
}

}  // namespace kilolux
