// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "host/scene/camera.h"
#include "host/scene/lights/light_groups.h"

namespace kilolux {

/// What the light of a group's lights is multiplied by.
struct GroupGain {
    std::string name;       // of a group, or kRestGroup
    float gain = 1.0f;      // at least 0
    glm::vec3 color{1.0f};  // linear red, green and blue, at least 0
    glm::vec3 factors() const { return gain * color; }
    bool operator==(const GroupGain&) const = default;
};

/// Gains of groups of lights: the picture is that of a scene whose lights have the intensities of
/// mixed_lights() and mixed_generated().
struct LightMix {
    std::vector<GroupGain> gains;    // groups without one keep their light
    std::vector<LightGroup> groups;  // of the scene, all of them
    bool operator==(const LightMix&) const = default;
};

/// Gains from `NAME=GAIN[:COLOR],...`, COLOR as "#RRGGBB" (sRGB) or "R,G,B" (linear); "none": no
/// gain. Throws UsageError, which names `option`.
std::vector<GroupGain> parse_light_mix(const std::string& option, const std::string& text);
std::string text_of(const std::vector<GroupGain>& gains);

/// Throws UsageError for a gain whose name is none of the mix's groups.
void check_light_mix(const LightMix& mix);

/// The factors of each group's light, by group_of(): [1 + groups].
std::vector<glm::vec3> factors_of(const LightMix& mix);

/// The scene's lights with the intensities that the mix gives them.
std::vector<SceneLight> mixed_lights(const Scene& scene, const LightMix& mix);
/// The same; `groups` keeps each light's group from call to call.
std::vector<SceneLight> mixed_lights(const Scene& scene, const LightMix& mix, GroupNumbers& groups);

/// The scene's own lights, then the generated ones, at `time` [s], with the intensities that the
/// mix gives them. Headlights are placed by `camera`.
std::vector<SceneLight> all_lights(const Scene& scene, const LightOptions& generated,
                                   const LightMix& mix, const Camera& camera, double time);

/// What makes the generated lights with the intensities that the mix gives them.
LightOptions mixed_generated(LightOptions generated, const Scene& scene, const LightMix& mix);

}  // namespace kilolux
