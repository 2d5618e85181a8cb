// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/scene/animated_scene.h"
#include "present/cli/options.h"
#include "present/window/app/awaited.h"
#include "present/window/app/render_worker.h"
#include "present/window/app/view_state.h"

namespace kilolux {

/// The lights that a rig adds to the scene. The panel chooses another rig; the worker then replaces
/// the lights.
class SceneLights {
 public:
    /// `asked`: the options before light_scene(); `lit`: after it.
    SceneLights(AnimatedScene& scene, SharedOptions asked, SharedOptions lit, Rig rig)
        : scene_(scene), asked_(std::move(asked)), lit_(std::move(lit)), rig_(rig) {}

    /// Whether the lights and their tails are those of the state's rig, renderer, shading and
    /// shadows.
    bool fit(const ViewState& state) const;
    /// The state's settings. Automatic tails are replaced by those that light_scene() chose.
    RenderSettings settings_of(const ViewState& state) const;

    /// Asks for the lights of the state's rig; `settings`: of the next picture.
    void replace(RenderWorker& worker, const ViewState& state, const RenderSettings& settings);
    /// Takes the new lights, and writes the settings that depend on them to the state. After a
    /// failure the former lights stay.
    void take(ViewState& state, const OnFailure& failed);
    bool are_changing() const { return relit_.is_open(); }

    /// Later rigs use the program's defaults instead of the command line's options of lights.
    void forget_command_line(const RenderSettings& defaults);

    Rig rig() const { return rig_; }  // of the lights that the scene has
    const SharedOptions& options() const { return lit_; }

 private:
    struct Relit {
        SharedOptions options;  // after light_scene()
        std::string line;       // the lines of light_scene()
    };

    AnimatedScene& scene_;  // its lights are the worker's
    SharedOptions asked_, lit_;
    Rig rig_;
    Awaited<Relit> relit_;
};

}  // namespace kilolux
