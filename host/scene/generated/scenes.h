// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// Names that make_generated_scene() knows, the default first.
std::vector<std::string> generated_scene_names();

bool is_generated_scene(std::string_view name);

/// A scene made by code from `seed`, with at least one camera (the first is the default view).
/// `atrium`: a columned hall round an open court, about 250,000 triangles, textured. `grid`: a
/// small scene for tests: floor, spheres and boxes with every material feature. `lanterns`: the
/// atrium by night, lit by lights with a size; the others have no lights. Throws Error for an
/// unknown name.
Scene make_generated_scene(std::string_view name, std::uint64_t seed = 1);

}  // namespace kilolux
