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

/// Whether the scene has surfaces that --emissive-lights could make lights.
bool has_glowing_surfaces(const Scene& scene);

/// The scene's own lights, those that a rig adds to them, and those of emissive surfaces. The panel
/// changes lights and chooses another rig; the worker then replaces the scene's.
class SceneLights {
 public:
    /// `asked`: the options before light_scene(); `lit`: after it.
    SceneLights(AnimatedScene& scene, SharedOptions asked, SharedOptions lit, Rig rig);

    /// The scene's own lights as the user wants them.
    OwnLights& own() { return own_; }
    const OwnLights& own() const { return own_; }

    /// Whether the lights and their tails are those of the state's rig, renderer and shadows.
    bool fit(const ViewState& state) const;
    /// Whether emissive surfaces light the scene as the state says.
    bool surfaces_fit(const ViewState& state) const;
    /// Whether the scene has_glowing_surfaces().
    bool can_glow() const { return can_glow_; }
    /// The state's settings. Automatic tails are replaced by those that light_scene() chose.
    RenderSettings settings_of(const ViewState& state) const;

    /// Asks for the lights of the state's rig; `settings`: of the next picture.
    void replace(RenderWorker& worker, const ViewState& state, const RenderSettings& settings);
    /// Asks only for the changes of the scene's own lights and of those of surfaces.
    void change(RenderWorker& worker, const ViewState& state, const RenderSettings& settings);
    /// Takes the new lights, and writes the settings that depend on them to the state. After a
    /// failure the former lights stay.
    void take(ViewState& state, const OnFailure& failed);
    bool are_changing() const { return relit_.is_open(); }
    /// Whether the scene lacks lights that the user wants.
    bool are_awaited() const { return are_changing() || own_.has_news(); }

    /// Later rigs use the program's defaults instead of the command line's options of lights.
    void forget_command_line(const RenderSettings& defaults);

    const SharedOptions& options() const { return lit_; }
    /// How often the scene's lights have been replaced.
    std::uint32_t version() const { return version_; }

 private:
    struct Relit {
        SharedOptions options;  // after light_scene()
        std::string line;       // the lines of light_scene()
        bool with_rig = true;   // else only own lights and those of surfaces have changed
    };
    // What decides whether surfaces light the scene: see choose_emissive_lights().
    struct SurfaceChoice {
        EmissiveLights emissive = EmissiveLights::automatic;
        bool take_sizes = false, generates = false;  // of automatic ones
        bool operator==(const SurfaceChoice&) const = default;
    };
    static SurfaceChoice choice_of(EmissiveLights emissive, const RenderSettings& settings);
    void ask(RenderWorker& worker, const SharedOptions& asked, const RenderSettings& settings,
             bool with_rig);

    AnimatedScene& scene_;  // its lights are the worker's
    SharedOptions asked_, lit_;
    Rig rig_;  // of the lights that the scene has
    bool can_glow_;
    SurfaceChoice surfaces_;  // that the scene has, or that failed
    OwnLights own_;
    std::uint32_t version_ = 0;
    Awaited<Relit> relit_;
};

}  // namespace kilolux
