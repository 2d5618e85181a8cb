// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/lights/light_generator.h"
#include "host/scene/scene.h"

namespace kilolux {

/// Lights whose light a picture holds in a layer of its own.
struct LightGroup {
    std::string name;                   // letters, digits, - and _
    std::vector<std::string> patterns;  // a light that matches one of them is in the group
    std::vector<int> nodes;             // or is of one of these nodes: see SceneLight::node
    bool operator==(const LightGroup&) const = default;
};

/// Most groups: kernels hold a sum for each.
inline constexpr std::size_t kMostLightGroups = 64;
/// The group of all light that is in no other; no group may have its name.
inline constexpr std::string_view kRestGroup = "rest";
/// In place of groups: a group for each light of the scene's file.
inline constexpr std::string_view kEachLight = "each";

/// What patterns may say, for --help.
std::string light_pattern_meaning();

/// Groups from `NAME=PATTERN[+PATTERN...],...`, or kEachLight; "none": no group. Throws
/// UsageError, which names `option`.
std::vector<LightGroup> parse_light_groups(const std::string& option, const std::string& text);
std::string text_of(const std::vector<LightGroup>& groups);

/// The groups of a scene: kEachLight becomes a group for each light, named as its node. Throws
/// UsageError for a group that no light is in, and for more than kMostLightGroups.
std::vector<LightGroup> light_groups_of(const Scene& scene, const LightOptions& generated,
                                        const std::vector<LightGroup>& asked);

/// The number of the first group that the light is in, from 1 on; 0: it is in none.
std::uint8_t group_of(const SceneLight& light, const Scene& scene,
                      std::span<const LightGroup> groups);

/// A light that is in the groups of the generated ones.
SceneLight generated_light(const LightOptions& options);

/// group_of() each light of a scene that changes.
class GroupNumbers {
 public:
    /// [scene.lights.size()], valid until the next call. Matches patterns again only where groups,
    /// or what patterns ask of lights, have changed.
    const std::vector<std::uint8_t>& of(const Scene& scene, const std::vector<LightGroup>& groups);

 private:
    struct Asked {  // by patterns
        int node = -1, web = -1;
        LightType type{};
        bool of_surface = false;
        bool operator==(const Asked&) const = default;
    };
    static Asked asked_of(const SceneLight& light, const Scene& scene);

    std::vector<LightGroup> groups_;
    std::vector<Asked> asked_;
    std::vector<std::uint8_t> numbers_;
};

}  // namespace kilolux
