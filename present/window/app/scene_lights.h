// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/scene/animated_scene.h"
#include "present/cli/options.h"
#include "present/window/app/awaited.h"
#include "present/window/app/own_lights.h"
#include "present/window/app/render_worker.h"
#include "present/window/app/view_state.h"

namespace kilolux {

/// The scene's own lights, and those that a rig adds to them. The panel changes lights and chooses
/// another rig; the worker then replaces the scene's.
class SceneLights {
 public:
    /// `asked`: the options before light_scene(); `lit`: after it.
    SceneLights(AnimatedScene& scene, SharedOptions asked, SharedOptions lit, Rig rig)
        : scene_(scene),
          asked_(std::move(asked)),
          lit_(std::move(lit)),
          rig_(rig),
          own_({scene.own_lights().begin(), scene.own_lights().end()}, lit_.load.light_size) {}

    /// The scene's own lights as the user wants them.
    OwnLights& own() { return own_; }
    const OwnLights& own() const { return own_; }

    /// Whether the lights and their tails are those of the state's rig, renderer, shading and
    /// shadows.
    bool fit(const ViewState& state) const;
    /// The state's settings. Automatic tails are replaced by those that light_scene() chose.
    RenderSettings settings_of(const ViewState& state) const;

    /// Asks for the lights of the state's rig; `settings`: of the next picture.
    void replace(RenderWorker& worker, const ViewState& state, const RenderSettings& settings);
    /// Asks only for the changes of the scene's own lights.
    void change(RenderWorker& worker, const ViewState& state, const RenderSettings& settings);
    /// Takes the new lights, and writes the settings that depend on them to the state. After a
    /// failure the former lights stay.
    void take(ViewState& state, const OnFailure& failed);
    bool are_changing() const { return relit_.is_open(); }
    /// Whether the scene lacks lights that the user wants.
    bool are_awaited() const { return are_changing() || own_.has_news(); }

    /// Later rigs use the program's defaults instead of the command line's options of lights.
    void forget_command_line(const RenderSettings& defaults);

    Rig rig() const { return rig_; }  // of the lights that the scene has
    const SharedOptions& options() const { return lit_; }

 private:
    struct Relit {
        SharedOptions options;  // after light_scene()
        std::string line;       // the lines of light_scene()
        bool with_rig = true;   // else only own lights have changed
    };
    void ask(RenderWorker& worker, const SharedOptions& asked, const RenderSettings& settings,
             bool with_rig);

    AnimatedScene& scene_;  // its lights are the worker's
    SharedOptions asked_, lit_;
    Rig rig_;
    OwnLights own_;
    Awaited<Relit> relit_;
};

}  // namespace kilolux
