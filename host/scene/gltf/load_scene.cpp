// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/load_scene.h"

#include "host/scene/animated_scene.h"

namespace kilolux {

Scene load_scene(const std::filesystem::path& file, const LoadOptions& options) {
    return AnimatedScene(file, options).take();
}

}  // namespace kilolux
