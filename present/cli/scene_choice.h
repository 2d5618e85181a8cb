// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/animated_scene.h"
#include "present/cli/options.h"

namespace kilolux {

/// Throws Error or UsageError where a name is no scene's: no generated one, no file, or one of
/// another kind. Reads no file.
void check_scene(const std::string& name_or_file);

/// Throws Error for an environment file that is not there, UsageError for another text that is no
/// name of a built-in one.
void check_environment(const std::string& name);

/// The scene of the options at their time, for other times, too: a generated one by name, else the
/// file of that path. Call light_scene() next. Throws UsageError for a text that is neither a name
/// nor looks like a file, Error if the file fails.
AnimatedScene open_animated_scene(const SharedOptions& options);

/// Treats the scene as --view says and adds the lights of the options' rig and environment, and
/// those of emissive surfaces where --emissive-lights says so. Writes the chosen rig, the number of
/// generated lights and the background to the options; returns lines that describe the lights.
std::string light_scene(SharedOptions& options, AnimatedScene& scene);

/// Makes emissive surfaces lights, or no lights, as --emissive-lights says. light_scene() calls it;
/// call it again for other lights.
void choose_emissive_lights(const SharedOptions& options, AnimatedScene& scene);

/// Finds the scene's lights of --light-groups. light_scene() calls it; call it again where the
/// scene's lights have changed. Throws UsageError as light_groups_of() does.
void choose_light_groups(SharedOptions& options, const Scene& scene);

/// Where the tails are automatic and bounded ranges would lose much of the light of the lights
/// without one: chooses a tree, or longer ranges where a tree cannot light the picture. Warns where
/// these are too many. light_scene() calls it; call it again for other lights.
void choose_tails(SharedOptions& options, const Scene& scene);

/// Makes a command that measures many lights use the swarm where no rig was asked for.
void measure_swarm(SharedOptions& options);

/// The lit scene of the options, at their time.
Scene open_scene(SharedOptions& options);

/// The camera of the options in their picture.
Camera choose_camera(const SharedOptions& options, const Scene& scene);

}  // namespace kilolux
