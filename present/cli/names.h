// SPDX-License-Identifier: Apache-2.0
// The command line's words for the enumerations of settings.h, in the enumerations' order, and
// their lines in --help.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "host/measure/bench/run.h"
#include "host/render/settings.h"
#include "host/scene/framing.h"
#include "host/scene/lights/glow/glowing_surfaces.h"
#include "host/scene/lights/rig.h"
#include "present/cli/progress.h"

namespace kilolux {

/// Words that an option takes, and a line of meaning for each or for none.
struct Choices {
    Choices(std::vector<std::string> words) : names(std::move(words)) {}
    Choices(std::initializer_list<std::pair<std::string, std::string>> described);
    std::vector<std::string> names;
    std::vector<std::string> meanings;
};

const Choices& choices_of(RendererKind);
const Choices& choices_of(Geometry);
const Choices& choices_of(Shading);
const Choices& choices_of(Shadows);
const Choices& choices_of(Tails);
const Choices& choices_of(BenchMotion);
const Choices& choices_of(ToneCurve);
const Choices& choices_of(Rig);
const Choices& choices_of(EmissiveLights);
const Choices& choices_of(Fit);
const Choices& choices_of(SeenFrom);
const Choices& choices_of(ProgressKind);
const Choices& choices_of(MathMode);
const Choices& choices_of(LightColors);
const Choices& choices_of(ViewKind);
const Choices& choices_of(SurfaceLayer);
Choices gbuffer_choices();
Choices aov_choices();
Choices metric_choices();

/// The words for an enumeration, and the word for one of its values.
template <typename Enum>
const std::vector<std::string>& names_of() {
    return choices_of(Enum{}).names;
}
template <typename Enum>
const std::string& name_of(Enum value) {
    return choices_of(value).names.at(static_cast<std::size_t>(value));
}

}  // namespace kilolux
