// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/render/settings.h"

namespace kilolux {

/// Throws UsageError for settings that exclude each other whatever the scene, so that a program can
/// refuse them before it loads one; Error for a name that settings.force_features does not know.
void check_settings(const RenderSettings& settings);

/// Why a shading model (SHADING_*) or shadows have no light of lights with a size: "shadows exact:
/// ...". Empty where they have.
std::string area_lights_problem(int shading, Shadows shadows);

/// Throws UsageError where area_lights_problem() says something.
void check_area_lights(int shading, Shadows shadows);

/// Whether lights with a size can light any scene with these settings.
bool take_area_lights(const RenderSettings& settings);

/// Whether Tails::tree can light the scene with these settings: a tree's nodes cast no shadows, and
/// only deferred has them, for opaque surfaces.
bool tree_can_light(const Scene& scene, const RenderSettings& settings);

}  // namespace kilolux
