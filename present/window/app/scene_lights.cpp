// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/scene_lights.h"

#include <utility>

#include "host/base/log.h"
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

void SceneLights::replace(RenderWorker& worker, const ViewState& state,
                          const RenderSettings& settings) {
    SharedOptions asked = with_rig(asked_, state.rig);
    asked.settings.renderer = state.settings.renderer;
    relit_ = Awaited(worker.ask([&scene = scene_, asked, settings](Renderer& renderer) {
        Relit out{asked, {}};
        RenderSettings next = settings;
        const std::vector<SceneLight> former = scene.added_lights();
        try {
            scene.replace_lights({});
            out.line = light_scene(out.options, scene);
            take_lit(next, out.options);
            renderer.change(next);
            renderer.refit();
            return out;
        } catch (...) {
            scene.replace_lights(former);
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
