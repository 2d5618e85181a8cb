// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "present/cli/options.h"
#include "present/window/app/camera_rig.h"

namespace kilolux {

/// The camera as command-line options. `first`: the command line of the window.
std::string camera_options(const CameraRig& rig, const SharedOptions& first, const Scene& scene);

/// The command that renders options.settings from this camera at options.time to kilolux.png.
/// Defaults are left out.
std::string render_command(const CameraRig& rig, const SharedOptions& options, const Scene& scene);

}  // namespace kilolux
