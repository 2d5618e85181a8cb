// SPDX-License-Identifier: Apache-2.0
#include "present/cli/options.h"

#include "host/base/suggest.h"
#include "host/picture/decoded_surfaces.h"
#include "host/scene/generated/scenes.h"
#include "present/cli/names.h"
#include "present/cli/option_builder.h"
#include "present/cli/setting_ranges.h"

namespace kilolux {
namespace {

void add_scene_option(CLI::App& command, SharedOptions& o) {
    Registrar(command, "Scene")
        .text({"SCENE", "", "atrium",
               "A generated scene (" + joined(generated_scene_names()) +
                   ") or a glTF 2.0 file, .gltf or .glb"},
              o.scene)
        .flag("--allow-outside-paths", o.allow_outside_paths,
              "Let the file name buffers and images outside its folder");
}

void add_picture_options(CLI::App& command, SharedOptions& o) {
    RenderSettings& s = o.settings;
    const auto resolution = [&s](const std::string& name, const std::string& text) {
        const auto size = parse_counts(name, text, "W,H", kEdgeRange);
        s.width = size[0];
        s.height = size[1];
    };
    const auto aovs = [&s](const std::string& name, const std::string& text) {
        s.want.aovs = parse_name_list(name, text, aov_names());
    };
    Registrar(command, "Picture")
        .choice({"--renderer", "", "deferred",
                 "Clustered deferred; clustered forward; forward or deferred with every light at "
                 "every pixel: the references"},
                s.renderer, renderer_names())
        .value({"--resolution", "W,H", "1920,1080", "Size in pixels"}, resolution)
        .choice({"--gbuffer", "", "packed", "What a pixel stores between the passes"}, s.gbuffer,
                gbuffer_names())
        .choice({"--shading", "", "auto", "How surfaces reflect; auto asks the scene's materials"},
                s.shading, shading_names())
        .number({"--ambient", "L", "0.02", "Radiance from everywhere, times the albedo"}, s.ambient,
                kAmbientRange)
        .count({"--samples", "N", "1", "Jittered samples a pixel"}, s.samples, kSamplesRange)
        .number({"--time", "T", "0", "Seconds: moves the lights and the file's animations"}, o.time)
        .choice({"--show", "", "lit", "What the picture shows"}, s.want.view, show_names())
        .value(
            {"--aov", joined(aov_names(), "|") + ",...", "none", "Layers beside an EXR's colour"},
            aovs);
}

void add_display_options(CLI::App& command, RenderSettings& s) {
    Registrar(command, "Display (PNG, JPEG, TIFF; EXR and HDR stay linear and unclamped)")
        .number({"--bloom", "K", "0", "Share of the light that blooms, 0 to 1"}, s.bloom,
                kBloomRange)
        .number({"--exposure", "EV", "0", "Twice as bright for every one"}, s.exposure,
                kExposureRange)
        .choice({"--tonemap", "", "neutral", "Curve from scene light to the display's range"},
                s.tone_curve, tone_curve_names());
}

void add_light_options(CLI::App& command, RenderSettings& s) {
    LightOptions& l = s.lights;
    const auto box = [&l](const std::string& name, const std::string& text) {
        l.box = parse_box(name, text);
    };
    Registrar(command, "Generated point lights, added to the file's own")
        .count({"--lights", "N", "5000", "How many; 0 keeps only the file's own"}, l.count,
               kLightsRange)
        .count({"--light-seed", "S", "1", "Decides places, colours and motion"}, l.seed,
               kLightSeedRange)
        .number_or_auto(
            {"--light-radius", "R|auto", "auto", "Range in metres; beyond it a light is exactly 0"},
            l.radius, kAboveZeroRange)
        .number_or_auto({"--light-intensity", "I|auto", "auto", "Brightest channel in candela"},
                        l.intensity, kAboveZeroRange)
        .value({"--light-box", "X0,Y0,Z0,X1,Y1,Z1", "the scene's", "Where they are, in metres"},
               box)
        .number({"--range-budget", "E", "0.00390625",
                 "Radiance that a light of the file without a range may be wrong by; decides its "
                 "range"},
                s.range_budget, kAboveZeroRange);
}

void add_camera_options(CLI::App& command, CameraChoice& c) {
    const auto index = [&c](const std::string& name, const std::string& text) {
        c.index = static_cast<int>(parse_count(name, text, {0, 0x7fffffff}));
    };
    const auto angle = [&c](const std::string& name, const std::string& text) {
        c.view_angle = parse_number(name, text, {0.0, 180.0, true});
    };
    Registrar(command, "Camera")
        .value({"--camera-index", "I", "the first, else one that frames the scene",
                "A camera of the scene, from 0"},
               index)
        .vector({"--camera-position", "X,Y,Z", "", "Where it stands, in metres"}, c.position)
        .vector({"--camera-focal-point", "X,Y,Z", "",
                 "What it looks at; with a position alone: the scene's middle"},
                c.focal_point)
        .vector({"--camera-view-up", "X,Y,Z", "0,1,0", "What is up in the picture"}, c.view_up)
        .value(
            {"--camera-view-angle", "DEG", "the camera's, else 45", "Vertical angle, in degrees"},
            angle)
        .flag("--camera-orthographic", c.orthographic, "Parallel projection");
}

void add_device_options(CLI::App& command, SharedOptions& o) {
    RenderSettings& s = o.settings;
    const auto grid = [&s](const std::string& name, const std::string& text) {
        const auto v = parse_counts(name, text, "X,Y,SLICES_PER_OCTAVE", kTilesRange);
        parse_count(name + ": slices per octave", std::to_string(v[2]), kSlicesRange);
        s.grid = {v[0], v[1], v[2]};
    };
    const auto lanes = [&s](const std::string& name, const std::string& text) {
        const std::size_t place = parse_name(name, text, {"auto", "1", "2", "4", "8", "16"});
        s.kernels.lanes = place == 0 ? 0 : 1 << (place - 1);
    };
    const auto memory = [&s](const std::string& name, const std::string& text) {
        s.max_memory_bytes = parse_bytes(name, text);
    };
    Registrar(command, "Device and tuning")
        .value({"--max-memory", "SIZE|auto", "auto",
                "Of the program, e.g. 512M or 4G: pictures that need more are made in bands, with "
                "the same bits; auto: most of what is available"},
               memory)
        .text({"--device", "NAME-OR-INDEX", "best", "OpenCL device"}, s.device)
        .question("--list-devices", "Print the OpenCL devices and leave")
        .value({"--grid", "X,Y,SLICES_PER_OCTAVE", "16,9,4",
                "Coarse clusters: tiles across and down, slices for each doubling of depth"},
               grid)
        .value({"--lanes", "auto|1|2|4|8|16", "auto",
                "Pixels or lights a work-item treats at once; changes no bit of a picture"},
               lanes)
        .choice({"--math", "", "exact", "How shading kernels compute: faster ones err a little"},
                s.kernels.math, math_names())
        .choice({"--light-colors", "", "float", "What shading kernels store lights' colours in"},
                s.kernels.light_colors, light_color_names());
}

}  // namespace

void add_shared_options(CLI::App& command, SharedOptions& options) {
    add_scene_option(command, options);
    add_picture_options(command, options);
    add_display_options(command, options.settings);
    add_light_options(command, options.settings);
    add_camera_options(command, options.camera);
    add_device_options(command, options);
    Registrar(command, "General")
        .flag("--quiet,-q", options.quiet, "Only warnings and errors on stderr")
        .flag("--verbose,-v", options.verbose, "More on stderr");
}

}  // namespace kilolux
