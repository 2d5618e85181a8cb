// SPDX-License-Identifier: Apache-2.0
// The words of the command line for what settings.h enumerates, each list in the enumeration's
// order, and what --help says of each.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "host/render/settings.h"

namespace kilolux {

/// Words that an option takes, and a line of meaning for each or for none.
struct Choices {
    Choices(std::vector<std::string> words) : names(std::move(words)) {}
    Choices(std::initializer_list<std::pair<std::string, std::string>> described);
    std::vector<std::string> names;
    std::vector<std::string> meanings;
};

Choices renderer_choices();
Choices shading_choices();
Choices tone_curve_choices();
Choices math_choices();
Choices light_color_choices();
Choices gbuffer_choices();
Choices geometry_choices();
Choices aov_choices();
Choices metric_choices();

/// Pictures of --show: what the renderer draws.
Choices show_choices();

inline std::vector<std::string> renderer_names() { return renderer_choices().names; }
inline std::vector<std::string> shading_names() { return shading_choices().names; }
inline std::vector<std::string> tone_curve_names() { return tone_curve_choices().names; }
inline std::vector<std::string> math_names() { return math_choices().names; }
inline std::vector<std::string> light_color_names() { return light_color_choices().names; }
inline std::vector<std::string> gbuffer_names() { return gbuffer_choices().names; }

std::string name_of(RendererKind renderer);
std::string name_of(Shading shading);
std::string name_of(ToneCurve curve);

}  // namespace kilolux
