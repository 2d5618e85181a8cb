// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/animated_scene.h"
#include "present/cli/options.h"

namespace kilolux {

/// The scene of the options at their time, to be put to other times: a generated one by name, else
/// the file of that path. light_scene() comes next. Throws UsageError for what is neither a name
/// nor looks like a file, Error if the file fails.
AnimatedScene open_animated_scene(const SharedOptions& options);

/// Takes the scene as --view says and adds the lights of the options' rig and environment. Which
/// rig that is, how many lights are generated and what is behind the scene is then settled in the
/// options; returns the lines that say it.
std::string light_scene(SharedOptions& options, AnimatedScene& scene);

/// Has a command that measures many lights do so where no rig was asked for.
void measure_swarm(SharedOptions& options);

/// The lit scene of the options, at their time.
Scene open_scene(SharedOptions& options);

/// The camera of the options in their picture.
Camera choose_camera(const SharedOptions& options, const Scene& scene);

}  // namespace kilolux
