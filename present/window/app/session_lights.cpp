// SPDX-License-Identifier: Apache-2.0
// The rig that the panel chooses: other lights in place of those that were added to the scene.
#include <utility>

#include "host/base/log.h"
#include "present/cli/scene_choice.h"
#include "present/window/app/session.h"

namespace kilolux {
namespace {

// The command line with another rig: what it says of lights was said for its own.
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

// What a rig decides of the settings.
void settle(RenderSettings& settings, const SharedOptions& lit) {
    settings.lights.count = lit.settings.lights.count;
    settings.ambient = lit.settings.ambient;
    settings.background = lit.shown_background;
    settings.reflections = lit.maps;
}

}  // namespace

void ViewSession::relight() {
    SharedOptions asked = with_rig(options_.asked, state_.rig);
    asked.settings.renderer = state_.settings.renderer;
    relighting_ = worker_->ask(
        [&scene = lit_scene_, asked, settings = wanted().settings](Renderer& renderer) {
            Relit out{asked, {}};
            RenderSettings next = settings;
            const std::vector<SceneLight> former = scene.added_lights();
            try {
                scene.replace_lights({});
                out.line = light_scene(out.options, scene);
                settle(next, out.options);
                renderer.change(next);
                renderer.refit();
                return out;
            } catch (...) {
                scene.replace_lights(former);
                throw;
            }
        });
}

// What needs the picture's settings, which belong to the lights to come.
void ViewSession::hold_back(Actions& actions) {
    for (bool Actions::*action : {&Actions::measure_error, &Actions::save_png, &Actions::save_exr,
                                  &Actions::copy_command}) {
        held_back_.*action |= std::exchange(actions.*action, false);
    }
}

void ViewSession::take_lights(Relit relit) {
    note(relit.line);
    settle(state_.settings, relit.options);
    options_.shared = std::move(relit.options);
    lit_by_ = state_.rig;
}

}  // namespace kilolux
