// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/scenes.h"

#include "host/base/error.h"
#include "host/scene/generated/atrium/atrium.h"
#include "host/scene/generated/atrium/lanterns.h"
#include "host/scene/generated/small.h"

namespace kilolux {
namespace {

struct GeneratedScene {
    std::string_view name;
    Scene (*make)(std::uint64_t seed);
};

constexpr GeneratedScene kScenes[] = {
    {"atrium", make_atrium},     {"grid", make_grid},         {"plain", make_plain},
    {"corridor", make_corridor}, {"lanterns", make_lanterns},
};

}  // namespace

std::vector<std::string> generated_scene_names() {
    std::vector<std::string> names;
    for (const GeneratedScene& scene : kScenes) names.emplace_back(scene.name);
    return names;
}

bool is_generated_scene(std::string_view name) {
    for (const GeneratedScene& scene : kScenes) {
        if (scene.name == name) return true;
    }
    return false;
}

Scene make_generated_scene(std::string_view name, std::uint64_t seed) {
    std::string names;
    for (const GeneratedScene& scene : kScenes) {
        if (scene.name == name) return scene.make(seed);
        names += (names.empty() ? "" : ", ") + std::string(scene.name);
    }
    throw Error("scene: '" + std::string(name) + "' is none of the generated scenes " + names);
}

}  // namespace kilolux
