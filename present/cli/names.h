// SPDX-License-Identifier: Apache-2.0
// The words of the command line for what settings.h enumerates; each list is in the enumeration's
// order.
#pragma once

#include <string>
#include <vector>

#include "host/render/settings.h"

namespace kilolux {

std::vector<std::string> renderer_names();
std::vector<std::string> shading_names();
std::vector<std::string> tone_curve_names();
std::vector<std::string> math_names();
std::vector<std::string> light_color_names();
std::vector<std::string> gbuffer_names();

/// Pictures of --show: what the renderer draws.
std::vector<std::string> show_names();

std::string name_of(RendererKind renderer);
std::string name_of(Shading shading);
std::string name_of(ToneCurve curve);

}  // namespace kilolux
