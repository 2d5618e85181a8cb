// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "present/cli/options.h"
#include "present/window/app/camera_rig.h"

namespace kilolux {

/// The camera as options of a command line: `first` is what the window began with.
std::string camera_options(const CameraRig& rig, const SharedOptions& first, const Scene& scene);

/// The command that renders the picture of `options.settings` from this camera at options.time; its
/// file is kilolux.png. Only what is not the default is named.
std::string render_command(const CameraRig& rig, const SharedOptions& options, const Scene& scene);

}  // namespace kilolux
