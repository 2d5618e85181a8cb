// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/light_mix.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "host/base/error.h"
#include "host/base/formats/color_text.h"
#include "host/base/suggest.h"
#include "host/base/text.h"
#include "host/scene/lights/light_generator.h"
#include "host/scene/lights/rig.h"

namespace kilolux {
namespace {

GroupGain parse_gain(const std::string& option, const std::string& text) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::size_t colon = std::min(text.find(':', equals), text.size());
    GroupGain out{text.substr(0, equals), 0.0f};
    const auto refuse = [&](const std::string& why) {
        throw UsageError(fmt::format("{}: '{}' {}", option, text, why));
    };
    if (out.name.empty() || equals == text.size()) refuse("is not NAME=GAIN[:COLOR]");
    const std::string number = text.substr(equals + 1, colon - equals - 1);
    const double gain = signed_number_of<double>(number).value_or(-1.0);
    if (!(gain >= 0.0 && gain <= std::numeric_limits<float>::max())) {
        refuse(
            fmt::format("has the gain '{}', which is not a finite number of at least 0", number));
    }
    out.gain = static_cast<float>(gain);
    if (colon == text.size()) return out;
    const std::string color = text.substr(colon + 1);
    const auto linear = rgb_color(color);
    const auto encoded = hex_color(color);
    if (!linear && !encoded) {
        refuse(
            fmt::format("has the colour '{}', which is neither R,G,B (linear factors of at "
                        "least 0) nor #RRGGBB (sRGB)",
                        color));
    }
    out.color = linear ? *linear : *encoded;
    return out;
}

std::vector<std::string> names_of(const std::vector<LightGroup>& groups) {
    std::vector<std::string> out;
    for (const LightGroup& group : groups) out.push_back(group.name);
    out.emplace_back(kRestGroup);
    return out;
}

}  // namespace

std::vector<GroupGain> parse_light_mix(const std::string& option, const std::string& text) {
    std::vector<GroupGain> out;
    if (text.empty() || text == "none") return out;
    std::vector<std::string> parts;  // "a=1:1,0.5,0" has commas, too
    for (const std::string_view word : split(text, ',')) {
        const bool goes_on = !parts.empty() && word.find('=') == std::string_view::npos &&
                             parts.back().find(':') != std::string::npos;
        if (goes_on) {
            parts.back() += ',' + std::string(word);
        } else {
            parts.emplace_back(word);
        }
    }
    for (const std::string& part : parts) {
        GroupGain gain = parse_gain(option, part);
        if (std::ranges::count(out, gain.name, &GroupGain::name) > 0) {
            throw UsageError(fmt::format("{}: two gains of '{}'", option, gain.name));
        }
        out.push_back(std::move(gain));
    }
    return out;
}

std::string text_of(const std::vector<GroupGain>& gains) {
    std::string out;
    for (const GroupGain& gain : gains) {
        out += fmt::format("{}{}={}", out.empty() ? "" : ",", gain.name, gain.gain);
        const glm::vec3& c = gain.color;
        if (c != glm::vec3(1.0f)) out += fmt::format(":{},{},{}", c.x, c.y, c.z);
    }
    return out;
}

void check_light_mix(const LightMix& mix) {
    const std::vector<std::string> names = names_of(mix.groups);
    for (const GroupGain& gain : mix.gains) {
        if (std::ranges::count(names, gain.name) > 0) continue;
        throw UsageError(fmt::format("light mix: '{}' is none of the light groups {}{}{}",
                                     gain.name, joined(names), did_you_mean(gain.name, names),
                                     mix.groups.empty() ? "; --light-groups names some" : ""));
    }
}

std::vector<glm::vec3> factors_of(const LightMix& mix) {
    std::vector<glm::vec3> out(1 + mix.groups.size(), glm::vec3(1.0f));
    for (const GroupGain& gain : mix.gains) {
        const auto found = std::ranges::find(mix.groups, gain.name, &LightGroup::name);
        const bool is_rest = found == mix.groups.end();
        out[is_rest ? 0 : static_cast<std::size_t>(found - mix.groups.begin()) + 1] =
            gain.factors();
    }
    return out;
}

std::vector<SceneLight> mixed_lights(const Scene& scene, const LightMix& mix) {
    GroupNumbers groups;
    return mixed_lights(scene, mix, groups);
}

std::vector<SceneLight> mixed_lights(const Scene& scene, const LightMix& mix,
                                     GroupNumbers& groups) {
    std::vector<SceneLight> out = scene.lights;
    if (mix.gains.empty()) return out;
    const std::vector<glm::vec3> factors = factors_of(mix);
    const std::vector<std::uint8_t>& numbers = groups.of(scene, mix.groups);
    for (std::size_t i = 0; i < out.size(); ++i) out[i].intensity *= factors[numbers[i]];
    return out;
}

std::vector<SceneLight> all_lights(const Scene& scene, const LightOptions& generated,
                                   const LightMix& mix, const Camera& camera, double time) {
    std::vector<SceneLight> out = mixed_lights(scene, mix);
    for (SceneLight& light : out) {
        light = placed_light(light, camera.world_from_view, camera.position);
    }
    const std::vector<SceneLight> made =
        generate_lights(mixed_generated(generated, scene, mix), scene, time);
    out.insert(out.end(), made.begin(), made.end());
    return out;
}

LightOptions mixed_generated(LightOptions generated, const Scene& scene, const LightMix& mix) {
    if (mix.gains.empty()) return generated;
    generated.gain = factors_of(mix)[group_of(generated_light(generated), scene, mix.groups)];
    return generated;
}

}  // namespace kilolux
