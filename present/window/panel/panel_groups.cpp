// SPDX-License-Identifier: Apache-2.0
#include "present/window/panel/panel_groups.h"

#include <imgui.h>

#include <algorithm>

namespace kilolux {
namespace {

// The gain of a group in a mix; a group without one keeps its light.
GroupGain gain_of(const GroupMix& mix, const std::string& name) {
    const auto found = std::ranges::find(mix.gains, name, &GroupGain::name);
    return found != mix.gains.end() ? *found : GroupGain{name};
}

// Only groups whose light changes are in the mix, and so in copied commands.
void set_gain(GroupMix& mix, const GroupGain& gain) {
    const auto found = std::ranges::find(mix.gains, gain.name, &GroupGain::name);
    if (gain == GroupGain{gain.name}) {
        if (found != mix.gains.end()) mix.gains.erase(found);
    } else if (found != mix.gains.end()) {
        *found = gain;
    } else {
        mix.gains.push_back(gain);
    }
}

}  // namespace

void PanelGroups::groups() const {
    GroupMix& mix = state.settings.light_mix;
    if (mix.groups.empty() || !ui.section("Light groups", true)) return;
    ui.begin_group("mix");
    for (const LightGroup& light_group : mix.groups) group(light_group.name);
    group(std::string(kRestGroup));
    if (ui.button("Reset", false, !mix.gains.empty())) mix.gains.clear();
    ui.tip("Gain 1 and white for all groups");
    ui.end_group();
}

void PanelGroups::group(const std::string& name) const {
    GroupGain gain = gain_of(state.settings.light_mix, name);
    constexpr double kMostGain = 4.0;
    bool changed = ui.slider(name.c_str(), gain.gain, {0.0, kMostGain, true, "%.3f"}, "mute");
    ui.tip("Multiplies the light of this group; Ctrl+click to type a number");
    ImGui::SameLine();
    bool is_mute = gain.gain == 0.0f;
    if (ui.checkbox("mute", is_mute, name.c_str())) {
        gain.gain = is_mute ? 0.0f : 1.0f;
        changed = true;
    }
    changed |= ui.color((name + " colour").c_str(), gain.color);
    gain.color = glm::max(gain.color, 0.0f);  // a typed number may be below
    if (changed) set_gain(state.settings.light_mix, gain);
}

}  // namespace kilolux
