// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/scene/lights/environment.h"

namespace kilolux {

/// Soft boxes around an object in a dim room: key from the upper left of +Z, the front of a glTF
/// model, fill from the right, a strip behind, one above, light from the floor.
Environment studio_environment();

/// A clear sky with a sun 40 degrees high, ahead of +Z on the left, over grey ground: Preetham,
/// Shirley, Smits 1999, "A Practical Analytic Model for Daylight", turbidity 3. The sun gives 3 lx
/// to a surface that faces it, the sky 1 lx to the ground: real daylight is about 30,000 times as
/// bright.
Environment sky_environment();

/// "studio", "sky".
const std::vector<std::string>& built_in_environment_names();
bool is_built_in_environment(std::string_view name);

/// The built-in environment of that name, else the file's: read_environment().
Environment environment_of(const std::string& name_or_file, std::uint64_t max_memory_bytes = 0);

}  // namespace kilolux
