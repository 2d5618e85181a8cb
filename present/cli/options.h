// SPDX-License-Identifier: Apache-2.0
// The options that the subcommands share: one spelling, default and check. Checks throw UsageError
// while the command line is parsed.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "host/render/settings.h"
#include "host/scene/gltf/load_scene.h"
#include "host/scene/lights/rig.h"
#include "present/cli/background_choice.h"
#include "present/cli/camera_choice.h"
#include "present/cli/sequence.h"
#include "present/image/display_picture.h"

namespace kilolux {

/// Options of every subcommand: which picture of which scene, on which device.
struct SharedOptions {
    std::string scene = "atrium";  // a generated scene's name, or a .gltf or .glb file
    LoadOptions load;              // how a file is read; its time and memory are the picture's
    RenderSettings settings;
    Rig rig = Rig::automatic;
    std::string environment;                              // file or built-in name; empty: none
    BackgroundChoice background;                          // behind the scene
    std::shared_ptr<const Environment> shown_background;  // as light_scene() settles it
    bool reflections = false;  // the environment lights by prefiltered maps, not by lights
    std::shared_ptr<const PrefilteredEnvironment> maps;  // as light_scene() settles it
    bool shows_environment = false;          // the command can show background and reflections
    std::uint64_t environment_lights = 128;  // that stand for it
    bool lights_given = false;               // settings.lights.count was asked for
    bool ambient_given = false;              // settings.ambient was
    bool shadow_rays_given = false;          // settings.shadow_rays was
    bool takes_automatic_exposure = false;   // the command can make it
    bool automatic_exposure = false;
    bool takes_automatic_samples = false;  // the command can choose them
    CameraChoice camera;
    double time = 0.0;        // [s]
    bool show_error = false;  // --show error: the picture's error against --reference
    bool quiet = false;
    bool verbose = false;
};

/// Options of commands that write pictures.
struct OutputOptions {
    std::filesystem::path output;
    bool half_colour = false;
    int bits = 8;  // a channel, of PNG and TIFF
    OcioOptions ocio;
    std::optional<FrameRange> frames;
    double frames_per_second = 24.0;
    Shard shard;
    std::optional<double> turntable;    // [degree] over the frames
    std::filesystem::path camera_keys;  // empty: none
    bool skip_existing = false;
    std::string stats;  // file, "-" for stdout, empty: none
    std::string reference;
    std::optional<double> threshold;
    std::string metric = "rmse";
    std::filesystem::path difference;  // empty: none
};

/// Scene, picture, lights, camera, grid and device options.
void add_shared_options(CLI::App& command, SharedOptions& options);

/// Sets what is printed. Throws UsageError for shared options that exclude or need each other;
/// `compares`: the command line has --reference.
void begin_command(const SharedOptions& options, bool compares = false);

/// Long names and values of the shared options, in their order: what a command line would have to
/// say for them. A flag's value is "true" or empty.
std::vector<std::pair<std::string, std::string>> shared_option_texts(SharedOptions options);

/// Output, sequence, statistics and comparison options.
void add_output_options(CLI::App& command, OutputOptions& options);

/// Throws UsageError for options that exclude or need each other.
void check_output_options(const SharedOptions& shared, const OutputOptions& options);

}  // namespace kilolux
