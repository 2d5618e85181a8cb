// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/animated_scene.h"
#include "present/cli/options.h"

namespace kilolux {

/// The scene of the options, at their time: a generated one by name, else the file of that path.
/// Throws UsageError for what is neither a name nor looks like a file, Error if the file fails.
Scene open_scene(const SharedOptions& options);

/// That scene at `time` [s], to be put to other times.
AnimatedScene open_animated_scene(const SharedOptions& options, double time);

}  // namespace kilolux
