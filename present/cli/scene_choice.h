// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/scene/animated_scene.h"
#include "present/cli/options.h"

namespace kilolux {

/// The scene of a command line: a generated one by name, else the file of that path at `time` [s].
/// Throws UsageError for what is neither a name nor looks like a file, Error if the file fails.
Scene open_scene(const std::string& name_or_file, double time, bool allow_outside_paths = false);

/// The scene of the options, at their time.
Scene open_scene(const SharedOptions& options);

/// The scene of the options at `time` [s], to be put to other times.
AnimatedScene open_animated_scene(const SharedOptions& options, double time);

}  // namespace kilolux
