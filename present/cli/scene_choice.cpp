// SPDX-License-Identifier: Apache-2.0
#include "present/cli/scene_choice.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <set>

#include "host/base/error.h"
#include "host/base/suggest.h"
#include "host/scene/generated/scenes.h"
#include "host/scene/gltf/load_scene.h"
#include "present/cli/progress.h"

namespace kilolux {
namespace {

// Whether the extension is that of a picture.
bool is_picture(const std::filesystem::path& file) {
    static const std::set<std::string> extensions = {".png", ".jpg", ".jpeg", ".tif",  ".tiff",
                                                     ".exr", ".hdr", ".bmp",  ".webp", ".gif"};
    return extensions.contains(lower(file.extension().string()));
}

// The file that a name stands for which is not a generated scene's.
std::filesystem::path scene_file(const std::string& name_or_file) {
    std::filesystem::path file(name_or_file);
    if (std::filesystem::is_directory(file)) {
        throw Error(name_or_file + ": is a folder, not a scene file");
    }
    const bool named_as_file = file.has_extension() || file.has_parent_path();
    if (!std::filesystem::exists(file) && !named_as_file) {
        const std::vector<std::string> names = generated_scene_names();
        throw UsageError(fmt::format("scene '{}' is no file, and none of {}{}", name_or_file,
                                     joined(names), did_you_mean(name_or_file, names)));
    }
    if (is_picture(file)) {
        throw UsageError(
            fmt::format("scene '{}' is a picture; a scene is a .gltf or .glb file, or one of {} "
                        "(--output names the picture to write)",
                        name_or_file, joined(generated_scene_names())));
    }
    if (!std::filesystem::exists(file)) throw Error(name_or_file + ": no such scene file");
    return file;
}

// Throws for options that choose among what only files have.
void check_generated(const SharedOptions& options) {
    const std::string is_generated = ": " + options.scene + " is a generated scene, without ";
    if (!options.load.clips.empty()) throw UsageError("--clip" + is_generated + "animations");
    if (!options.load.variant.empty()) throw UsageError("--variant" + is_generated + "variants");
}

// A bar for the images of a file.
class LoadBar {
 public:
    explicit LoadBar(bool shown) : shown_(shown) {}
    void tell(std::size_t done, std::size_t total) {
        if (!bar_) bar_.emplace("loading images", total, shown_);
        if (done > 0) bar_->advance();
    }

 private:
    bool shown_;
    std::optional<Progress> bar_;
};

}  // namespace

Scene open_scene(const SharedOptions& options) {
    return open_animated_scene(options, options.time).take();
}

AnimatedScene open_animated_scene(const SharedOptions& options, double time) {
    if (is_generated_scene(options.scene)) {
        check_generated(options);
        return AnimatedScene(make_generated_scene(options.scene));
    }
    LoadBar bar(!options.quiet);
    LoadOptions load = options.load;
    load.time = time;
    load.max_memory_bytes = options.settings.max_memory_bytes;
    return AnimatedScene(scene_file(options.scene), load,
                         [&bar](std::size_t done, std::size_t total) { bar.tell(done, total); });
}

}  // namespace kilolux
