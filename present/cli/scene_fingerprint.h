// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kilolux {

/// A text that changes when a scene does: the name of a generated scene; of a scene file the path,
/// size and time of change, and the same of every file that it names (buffers, images).
std::string scene_fingerprint(const std::string& scene);

}  // namespace kilolux
