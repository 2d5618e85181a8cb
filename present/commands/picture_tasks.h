// SPDX-License-Identifier: Apache-2.0
// The pictures of `kilolux render`: which, and who makes them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "present/commands/devices/device_helpers.h"
#include "present/commands/picture_files.h"
#include "present/commands/scene_renderer.h"

namespace kilolux {

/// The pictures asked for, computed one at a time: a sequence may have 2^31 of them.
class PictureTasks {
 public:
    explicit PictureTasks(const RenderOptions& options);

    std::size_t size() const { return frames_ ? frames_->size() : 1; }
    PictureTask operator[](std::size_t i) const;

    /// Whether --skip-existing finds the picture.
    bool is_done(const PictureTask& task) const;
    std::size_t first_to_do() const;

 private:
    const RenderOptions& options_;
    std::optional<ShardFrames> frames_;
    bool has_video_ = false;  // the one that is asked for is there
};

/// The devices of --device by index: of "all", or of several indices with commas between. Any other
/// text is returned alone, for choose_device(). Pictures of devices that differ in name, platform
/// or driver may differ: unless `mixed`, "all" are those like the best one, with a note of the
/// others, and indices of such devices throw UsageError, as does an index that is there twice.
std::vector<std::string> devices_of(const std::string& choice, bool mixed);

struct MadePictures {
    WrittenPictures written;
    std::vector<DeviceShare> shares;  // of several devices
};

/// Renders and writes the pictures from `first` on that are not there. `more_devices` help
/// `pictures`, each with a renderer and a thread of its own, which begins like `pictures` did, by
/// `start`. A device that fails is left out, and others make its picture again. Throws its error
/// where none is left.
MadePictures render_tasks(const RenderOptions& options, const PictureTasks& tasks,
                          std::size_t first, SceneRenderer& pictures, const FirstPicture& start,
                          const std::vector<std::string>& more_devices);

/// Renders and writes a single picture, which several devices make by rows or strips.
MadePictures render_with_helpers(const RenderOptions& options, const PictureTask& task,
                                 SceneRenderer& pictures, DeviceHelpers& helpers);

}  // namespace kilolux
