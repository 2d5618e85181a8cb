// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/scene_lights.h"

#include <algorithm>
#include <utility>

#include "host/base/log.h"
#include "host/render/plan/settings_check.h"
#include "host/scene/lights/glow/mean_emission.h"
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
    settings.light_mix.groups = lit.settings.light_mix.groups;
    settings.background = lit.shown_background;
    settings.reflections = lit.maps;
}

// Takes the settings that decide automatic tails and emissive lights.
void take_tail_settings(RenderSettings& settings, const RenderSettings& from) {
    settings.tails = from.tails;
    settings.renderer = from.renderer;
    settings.shadows = from.shadows;
    settings.shading = from.shading;
    settings.light_mix.gains = from.light_mix.gains;
}

}  // namespace

bool has_glowing_surfaces(const Scene& scene) {
    return std::ranges::any_of(scene.instances, [&](const Instance& instance) {
        const auto looks = looks_of(scene, scene.meshes[static_cast<std::size_t>(instance.mesh)]);
        return std::ranges::any_of(looks, [](const Material* look) { return glows(*look); });
    });
}

SceneLights::SceneLights(AnimatedScene& scene, SharedOptions asked, SharedOptions lit, Rig rig)
    : scene_(scene),
      asked_(std::move(asked)),
      lit_(std::move(lit)),
      rig_(rig),
      can_glow_(has_glowing_surfaces(scene.scene())),
      surfaces_(choice_of(lit_.emissive_lights, lit_.settings)),
      own_({scene.own_lights().begin(), scene.own_lights().end()}, lit_.load.light_size) {}

SceneLights::SurfaceChoice SceneLights::choice_of(EmissiveLights emissive,
                                                  const RenderSettings& settings) {
    if (emissive != EmissiveLights::automatic) return {emissive};
    return {emissive, take_area_lights(settings), settings.lights.count > 0};
}

bool SceneLights::surfaces_fit(const ViewState& state) const {
    return !can_glow_ || choice_of(state.emissive_lights, state.settings) == surfaces_;
}

bool SceneLights::fit(const ViewState& state) const {
    if (state.rig != rig_) return false;
    const RenderSettings &now = state.settings, &lit = lit_.settings;
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
        take_tail_settings(options->settings, state.settings);
    }
    asked_.emissive_lights = state.emissive_lights;
    ask(worker, with_rig(asked_, state.rig), settings, true);
}

void SceneLights::change(RenderWorker& worker, const ViewState& state,
                         const RenderSettings& settings) {
    SharedOptions asked = lit_;
    take_tail_settings(asked_.settings, state.settings);
    take_tail_settings(asked.settings, state.settings);
    asked.emissive_lights = asked_.emissive_lights = state.emissive_lights;
    asked.settings.lights.count = state.settings.lights.count;
    asked.settings.ambient = state.settings.ambient;
    asked.settings.range_budget = asked_.settings.range_budget;
    ask(worker, asked, settings, false);
}

void SceneLights::ask(RenderWorker& worker, const SharedOptions& asked,
                      const RenderSettings& settings, bool with_rig) {
    relit_ = Awaited(worker.ask([&scene = scene_, own = own_.begin_sending(), asked, settings,
                                 with_rig](Renderer& renderer) {
        Relit out{asked, {}, with_rig};
        const std::vector<SceneLight> former_added = scene.added_lights();
        const std::vector<NumberedLight> former_own = scene.exchange_lights(own);
        const bool glowed = scene.glow() != nullptr;
        try {
            if (with_rig) {
                scene.replace_lights({});
                out.line = light_scene(out.options, scene);
            } else {
                choose_emissive_lights(out.options, scene);
                choose_tails(out.options, scene.scene());
            }
            RenderSettings next = settings;
            take_lit(next, out.options);
            next.tails = out.options.settings.tails;
            next.range_budget = out.options.settings.range_budget;
            renderer.change(next);
            renderer.refit();
            return out;
        } catch (...) {
            scene.exchange_lights(former_own);
            scene.replace_lights(former_added);
            scene.light_by_surfaces(glowed);
            throw;
        }
    }));
}

void SceneLights::take(ViewState& state, const OnFailure& failed) {
    if (!are_changing()) return;
    const auto take_relit = [&](Relit relit) {
        own_.end_sending(true);
        if (relit.with_rig) {
            note(relit.line);
            take_lit(state.settings, relit.options);
            rig_ = state.rig;
        }
        lit_ = std::move(relit.options);
        surfaces_ = choice_of(lit_.emissive_lights, lit_.settings);
        ++version_;
    };
    if (relit_.take(take_relit, failed)) return;
    own_.end_sending(false);
    state.rig = rig_;
    state.settings.lights.size = own_.point_size();
    state.emissive_lights = lit_.emissive_lights;
    surfaces_ = choice_of(state.emissive_lights, state.settings);
}

void SceneLights::forget_command_line(const RenderSettings& defaults) {
    asked_.settings.lights = defaults.lights;
    asked_.settings.ambient = defaults.ambient;
    asked_.lights_given = asked_.ambient_given = false;
}

}  // namespace kilolux
