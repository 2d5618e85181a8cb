// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/scene_lights.h"

#include <utility>

#include "host/base/log.h"
#include "host/render/plan/settings_check.h"
#include "present/cli/scene_choice.h"

namespace kilolux {
namespace {

// The command line's options with another rig: its options of lights belong to its own rig.
SharedOptions with_rig(SharedOptions asked, Rig rig) {
    if (rig != Rig::automatic && rig != asked.rig) {
        asked.lights_given = asked.ambient_given = false;
        asked.settings.ambient = RenderSettings().ambient;
        std::uint64_t& count = asked.settings.lights.count;
        if (count == 0) count = RenderSettings().lights.count;
    }
    asked.rig = rig;
    return asked;
}

// Takes the settings that depend on the rig.
void take_lit(RenderSettings& settings, const SharedOptions& lit) {
    settings.lights.count = lit.settings.lights.count;
    settings.ambient = lit.settings.ambient;
    settings.background = lit.shown_background;
    settings.reflections = lit.maps;
}

}  // namespace

bool SceneLights::fit(const ViewState& state) const {
    if (state.rig != rig_) return false;
    const RenderSettings &now = state.settings, &lit = lit_.settings;
    if (asked_.emissive_lights == EmissiveLights::automatic && lit_.rig == Rig::none &&
        take_area_lights(now) != take_area_lights(lit)) {
        return false;
    }
    if (now.tails != Tails::automatic) return true;
    if (asked_.settings.tails != Tails::automatic) return false;
    return lit.tails == Tails::automatic ||
           (now.renderer == lit.renderer && now.shadows == lit.shadows);
}

RenderSettings SceneLights::settings_of(const ViewState& state) const {
    RenderSettings out = state.settings;
    if (out.tails != Tails::automatic || !fit(state)) return out;
    out.tails = lit_.settings.tails;
    out.range_budget = lit_.settings.range_budget;
    return out;
}

void SceneLights::replace(RenderWorker& worker, const ViewState& state,
                          const RenderSettings& settings) {
    lit_.settings.range_budget = asked_.settings.range_budget;
    for (SharedOptions* options : {&asked_, &lit_}) {  // a failure is not tried again
        options->settings.tails = state.settings.tails;
        options->settings.renderer = state.settings.renderer;
        options->settings.shadows = state.settings.shadows;
        options->settings.shading = state.settings.shading;
    }
    const SharedOptions asked = with_rig(asked_, state.rig);
    relit_ = Awaited(worker.ask([&scene = scene_, asked, settings](Renderer& renderer) {
        Relit out{asked, {}};
        RenderSettings next = settings;
        const std::vector<SceneLight> former = scene.added_lights();
        const bool glowed = scene.glow() != nullptr;
        try {
            scene.replace_lights({});
            out.line = light_scene(out.options, scene);
            take_lit(next, out.options);
            next.tails = out.options.settings.tails;
            next.range_budget = out.options.settings.range_budget;
            renderer.change(next);
            renderer.refit();
            return out;
        } catch (...) {
            scene.replace_lights(former);
            scene.light_by_surfaces(glowed);
            throw;
        }
    }));
}

void SceneLights::take(ViewState& state, const OnFailure& failed) {
    const auto take_relit = [&](Relit relit) {
        note(relit.line);
        take_lit(state.settings, relit.options);
        lit_ = std::move(relit.options);
        rig_ = state.rig;
    };
    if (!relit_.take(take_relit, failed)) state.rig = rig_;
}

void SceneLights::forget_command_line(const RenderSettings& defaults) {
    asked_.settings.lights = defaults.lights;
    asked_.settings.ambient = defaults.ambient;
    asked_.lights_given = asked_.ambient_given = false;
}

}  // namespace kilolux
