// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "present/commands/devices/device_helpers.h"
#include "present/commands/picture_tasks.h"
#include "present/commands/scene_renderer.h"

namespace kilolux {

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
