// SPDX-License-Identifier: Apache-2.0
// The options that the subcommands share: one spelling, default and check. Checks throw UsageError
// while the command line is parsed.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "host/render/settings.h"
#include "host/scene/gltf/load_scene.h"
#include "host/scene/lights/glow/glowing_surfaces.h"
#include "host/scene/lights/rig.h"
#include "present/cli/camera_choice.h"
#include "present/cli/option_values.h"
#include "present/cli/progress.h"
#include "present/cli/sequence.h"
#include "present/cli/setting.h"
#include "present/image/display_picture.h"
#include "present/image/image_file.h"

namespace kilolux {

/// Options of every subcommand: which picture of which scene, on which device.
struct SharedOptions {
    std::string scene = "atrium";  // a generated scene's name, or a .gltf or .glb file
    LoadOptions load;              // how a file is read; its time and memory are the picture's
    RenderSettings settings;
    Rig rig = Rig::automatic;
    EmissiveLights emissive_lights = EmissiveLights::automatic;
    std::vector<LightGroup> light_groups;  // asked for; settings has those of the scene
    bool no_light_layers = false;          // groups serve settings.light_mix only
    bool takes_light_layers = true;        // the command's files can hold them
    std::string environment;               // file or built-in name; empty: none
    BackgroundChoice background;           // behind the scene
    std::shared_ptr<const Environment> shown_background;  // set by light_scene()
    bool reflections = false;  // the environment lights by prefiltered maps, not by lights
    std::shared_ptr<const PrefilteredEnvironment> maps;  // set by light_scene()
    // The command makes pictures to look at: they can show background and reflections.
    bool shows_environment = false;
    bool compares_renderers = false;         // it measures several with the same lights
    std::uint64_t environment_lights = 128;  // directional lights that replace it
    bool lights_given = false;               // settings.lights.count was asked for
    bool ambient_given = false;              // settings.ambient was asked for
    bool tone_curve_given = false;           // settings.tone_curve was asked for
    bool shadow_rays_given = false;          // settings.shadow_rays was asked for
    bool takes_automatic_exposure = false;   // the command can choose the exposure
    bool automatic_exposure = false;
    bool takes_automatic_samples = false;  // the command can choose them
    CameraChoice camera;
    double time = 0.0;        // [s]
    bool show_error = false;  // --show error: the picture's error against --reference
    ProgressKind progress = ProgressKind::automatic;
    bool quiet = false;
    bool verbose = false;
    ProgressKind shown_progress() const { return progress_kind(progress, quiet); }
    bool operator==(const SharedOptions&) const = default;
};

/// Calls `visit` with each option and its value in `options`, in the order of --help. The one list
/// of them: see Setting.
void visit_settings(SharedOptions& options, const SettingVisitor& visit);

/// The settings that differ from the same rows of the defaults and change `least` or more, as words
/// for a shell: " --lights 77 --rig none". Leaves out the scene and the options of printing.
std::string option_words(const std::vector<Setting>& settings, const std::vector<Setting>& defaults,
                         Changes least);

/// Sets the verbosity. Throws UsageError for shared options that exclude or need each other, Error
/// for an environment file that is not there; `compares`: the command line has --reference.
void begin_command(const SharedOptions& options, bool compares = false);

}  // namespace kilolux
