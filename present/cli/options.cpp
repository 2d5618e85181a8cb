// SPDX-License-Identifier: Apache-2.0
#include "present/cli/options.h"

#include <fmt/format.h>

#include <tuple>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/text.h"
#include "host/scene/generated/scenes.h"
#include "present/cli/names.h"
#include "present/cli/option_builder.h"

namespace kilolux {
namespace {

void add_scene_option(CLI::App& command, SharedOptions& o) {
    OptionBuilder(command, "Scene")
        .text({"SCENE", "", "atrium",
               "A generated scene (" + joined(generated_scene_names()) +
                   ") or a glTF 2.0 file, .gltf or .glb"},
              o.scene)
        .value({"--clip", "NAME-OR-INDEX[,...]", "the file's first",
                "Animations of the file that play, as info lists them; also all or none"},
               o.load.clips, parse_list)
        .text({"--variant", "NAME-OR-INDEX", "the file's own",
               "Variant of the file's materials, as info lists them"},
              o.load.variant)
        .flag("--strict", o.load.strict,
              "Refuse a file that has anything that the picture would lack; else a warning says "
              "so")
        .choice({"--view", "", "auto",
                 "From where the scene is seen and how it is lit; inside and outside mean the "
                 "automatic camera, unless there is --camera-index I"},
                o.camera.view)
        .rest()
        .value({"--line-width", "METRES|PERCENT%", "0.2%",
                "Width of points and lines: a share of the scene's diagonal, or metres"},
               o.load.line_width, parse_line_width)
        .flag("--allow-outside-paths", o.load.allow_outside_paths,
              "Let the file name buffers and images outside its folder");
}

// The renderer's views, and the comparison's.
Choices show_choices() {
    Choices choices = choices_of(ViewKind{});
    choices.names.emplace_back("error");
    choices.meanings.emplace_back("heat map of the relative error to --reference (render only)");
    return choices;
}

void add_picture_options(CLI::App& command, SharedOptions& o) {
    RenderSettings& s = o.settings;
    const auto resolution = [&s](const std::string& name, const std::string& text) {
        std::tie(s.width, s.height) = parse_resolution(name, text);
    };
    const auto take_ambient = [&o](const std::string& name, const std::string& text) {
        o.settings.ambient = static_cast<float>(parse_number(name, text, kAmbientRange));
        o.ambient_given = true;
    };
    const auto take_rays = [&o](const std::string& name, const std::string& text) {
        o.settings.shadow_rays = static_cast<int>(parse_count(name, text, kShadowRaysRange));
        o.shadow_rays_given = true;
    };
    const auto take_samples = [&o, &s](const std::string& name, const std::string& text) {
        s.auto_samples.on = text == "auto";
        if (!s.auto_samples.on) {
            const auto parse = o.takes_automatic_samples ? parse_count_or_auto : parse_count;
            s.samples = static_cast<int>(parse(name, text, kSamplesRange));
        } else if (!o.takes_automatic_samples) {
            throw UsageError(name + ": only render makes it automatic");
        }
    };
    OptionBuilder(command, "Picture")
        .choice({"--renderer", "", "deferred", "How surfaces are lit"}, s.renderer)
        .value({"--resolution", "W,H", "1920,1080", "Size in pixels; WxH is as good"}, resolution,
               [&s] { return fmt::format("{},{}", s.width, s.height); })
        .value({"--samples", o.takes_automatic_samples ? "N|auto" : "N", "1",
                o.takes_automatic_samples
                    ? "Jittered samples a pixel; auto: as many as each tile of 16x16 pixels needs, "
                      "see --sample-error"
                    : "Jittered samples a pixel"},
               take_samples, [&s] { return s.auto_samples.on ? "auto" : text_of(s.samples); })
        .number({"--time", "T", "0", "Seconds: moves the lights and the file's animations"}, o.time)
        .choice(
            {"--show", "", "lit", "What the picture shows"}, show_choices(),
            [&o](std::size_t place) {
                o.show_error = place == view_names().size();
                o.settings.want.view = o.show_error ? ViewKind::lit : static_cast<ViewKind>(place);
            },
            [&o] { return o.show_error ? "error" : name_of(o.settings.want.view); })
        .choice_list({"--aov", "", "none", "Layers of an EXR file beside its colour"}, s.want.aovs,
                     aov_choices())
        .rest()
        .choice({"--gbuffer", "", "packed", "How a pixel is stored between the passes"}, s.gbuffer,
                gbuffer_choices())
        .choice({"--geometry", "", "auto", "How surfaces get into the G-buffer"}, s.geometry)
        .count({"--anisotropy", "N", "1 on CPUs, 8 on GPUs", "Texture samples along a footprint"},
               s.anisotropy, kAnisotropyRange)
        .number({"--sample-error", "E", "0.05",
                 "Of --samples auto: the standard error of a tile's luminance, relative to it, "
                 "that ends its samples; dark light counts as 0.1 of white at least"},
                s.auto_samples.error, kAboveZeroRange)
        .count({"--max-samples", "N", "256", "Of --samples auto: a pixel takes no more"},
               s.auto_samples.most, kAutoSamplesRange)
        .flag("--no-reuse", s.no_reuse, "Make what did not change anew every frame")
        .choice({"--shading", "", "auto", "How surfaces reflect light"}, s.shading)
        .choice({"--shadows", "", "off", "Which lights a surface sees"}, s.shadows)
        .value({"--shadow-rays", "N", "4; with --max-error as many as it takes",
                "Rays a pixel of sampled shadows, at most on average"},
               take_rays, [&s] { return text_of(s.shadow_rays); })
        .count({"--shadow-seed", "N", "1", "Random numbers of sampled shadows"}, s.shadow_seed,
               kSeedRange)
        .value({"--ambient", "L", "0.02; with the rig studio 0.2",
                "Radiance from everywhere, times the albedo"},
               take_ambient, [&s] { return text_of(s.ambient); });
}

// The curves, and Khronos PBR Neutral by its whole name.
Choices tone_curve_choices() {
    Choices choices = choices_of(ToneCurve{});
    choices.names.emplace_back("pbr-neutral");
    choices.meanings.emplace_back("the same as neutral");
    return choices;
}

void add_display_options(CLI::App& command, SharedOptions& o) {
    RenderSettings& s = o.settings;
    const auto take_exposure = [&o](const std::string& name, const std::string& text) {
        o.automatic_exposure = text == "auto";
        if (o.automatic_exposure && !o.takes_automatic_exposure) {
            throw UsageError(name + ": only render makes it automatic");
        }
        const auto parse = o.takes_automatic_exposure ? parse_number_or_auto : parse_number;
        const double ev = parse(name, text, kExposureRange);
        o.settings.exposure = static_cast<float>(ev);
    };
    const auto take_curve = [&s](std::size_t place) {
        const bool whole_name = place == names_of<ToneCurve>().size();
        s.tone_curve = whole_name ? ToneCurve::neutral : static_cast<ToneCurve>(place);
    };
    const auto take_background = [&o](const std::string& name, const std::string& text) {
        if (!o.shows_environment && text != "auto")
            throw UsageError(name + ": only render and view show it");
        return parse_background(name, text);
    };
    OptionBuilder(command, "Display (PNG, JPEG, TIFF; EXR and HDR stay linear and unclamped)")
        .value({"--exposure", o.takes_automatic_exposure ? "EV|auto" : "EV", "0",
                o.takes_automatic_exposure
                    ? "Each step doubles the brightness; auto: the log average of the picture's "
                      "luminance becomes 0.18, or less where more than 2 % would clip; a sequence "
                      "keeps that of its first frame"
                    : "Each step doubles the brightness"},
               take_exposure, [&s] { return text_of(s.exposure); })
        .choice({"--tonemap", "", "neutral", "Curve from scene light to the display's range"},
                tone_curve_choices(), take_curve, [&s] { return name_of(s.tone_curve); })
        .value(
            {"--background", "COLOUR|none|auto", "auto",
             "What is behind the scene: R,G,B linear or #RRGGBB in sRGB, as light that exposure "
             "and tone curve apply to; none: black, and clear in PNG and EXR without bloom; auto: "
             "the environment, else black"},
            o.background, take_background)
        .number({"--bloom", "K", "0", "Share of the light that blooms, 0 to 1"}, s.bloom,
                kBloomRange);
}

void add_light_options(CLI::App& command, SharedOptions& o) {
    RenderSettings& s = o.settings;
    LightOptions& l = s.lights;
    const auto take_count = [&o](const std::string& name, const std::string& text) {
        o.settings.lights.count = parse_count(name, text, kLightsRange);
        o.lights_given = true;
    };
    OptionBuilder(command, "Lights, added to the file's own")
        .choice({"--rig", "", "auto", "What lights the scene"}, o.rig)
        .value({"--lights", "N", "5000 with the rig swarm",
                "Generated point lights, e.g. 20k or 1e6, beside any rig; without --rig they are "
                "the rig, and 0 keeps only the file's own"},
               take_count, [&l] { return text_of(l.count); })
        .count({"--light-seed", "S", "1", "Decides places, colours and motion"}, l.seed,
               kLightSeedRange)
        .number_or_auto(
            {"--light-radius", "R|auto", "auto", "Range in metres; beyond it a light is exactly 0"},
            l.radius, kAboveZeroRange)
        .number_or_auto({"--light-intensity", "I|auto", "auto", "Brightest channel in candela"},
                        l.intensity, kAboveZeroRange)
        .text(
            {"--environment", "FILE|studio|sky", "",
             "Light from all around: an image, longitude by latitude, its middle towards -Z, e.g. "
             ".hdr or .exr; studio: soft boxes in a dim room; sky: a clear sky with a sun. Then "
             "--rig auto is "
             "none and --ambient 0"},
            o.environment)
        .rest()
        .flag("--reflections", o.reflections,
              "The environment lights by prefiltered maps (split sum) in place of lights, so that "
              "shiny metals reflect it; render and view; not what blends, no forward renderers")
        .count({"--environment-lights", "N", "128", "Directional lights that stand for it"},
               o.environment_lights, {1, 65536})
        .value({"--light-box", "X0,Y0,Z0,X1,Y1,Z1", "the scene's", "Where they are, in metres"},
               l.box, parse_box)
        .choice({"--tails", "", "auto", "Where the file's lights without a range end"}, s.tails)
        .number({"--range-budget", "E", "0.00390625",
                 "Decides the range of a bounded one: where it adds this radiance"},
                s.range_budget, kAboveZeroRange)
        .count({"--tail-seed", "N", "1", "Random numbers of stochastic ones"}, s.tail_seed,
               kSeedRange)
        .number({"--tree-share", "S", "0.3",
                 "What a group of a tree may err by, of the light that it sends"},
                s.tree_share, kShareRange);
}

void add_camera_options(CLI::App& command, CameraChoice& c) {
    const auto take_index = [&c](const std::string& name, const std::string& text) {
        c.framed = text == "auto";
        c.index.reset();
        if (!c.framed) c.index = static_cast<int>(parse_count(name, text, {0, 0x7fffffff}));
    };
    const auto show_index = [&c] { return c.framed ? std::string("auto") : text_of(c.index); };
    OptionBuilder(command, "Camera")
        .value({"--camera-index", "I|auto", "the first, else auto",
                "A camera of the scene, from 0; auto: one that sees the scene as --view says"},
               take_index, show_index)
        .value({"--camera-position", "X,Y,Z", "", "Where it stands, in metres"}, c.position,
               parse_vector)
        .value({"--camera-focal-point", "X,Y,Z", "",
                "What it looks at; with a position alone: the scene's middle"},
               c.focal_point, parse_vector)
        .rest()
        .value({"--camera-view-up", "X,Y,Z", "0,1,0", "What is up in the picture"}, c.view_up,
               parse_vector)
        .number(
            {"--camera-view-angle", "DEG", "the camera's, else 45", "Vertical angle, in degrees"},
            c.view_angle, {0.0, 180.0, true})
        .choice({"--fit", "", "both",
                 "What a picture of another shape keeps of a file's camera that has an aspect"},
                c.fit)
        .flag("--camera-orthographic", c.orthographic, "Parallel projection");
}

void add_device_options(CLI::App& command, SharedOptions& o) {
    RenderSettings& s = o.settings;
    const auto grid = [&s](const std::string& name, const std::string& text) {
        const auto [x, y, slices] = parse_grid(name, text);
        s.grid = {x, y, slices};
    };
    const auto grid_text = [&s] {
        return fmt::format("{},{},{}", s.grid.tiles_x, s.grid.tiles_y, s.grid.slices_per_octave);
    };
    OptionBuilder(command, "Device")
        .text({"--device", "NAME-OR-INDEX", "best", "OpenCL device"}, s.device)
        .question("--list-devices", "Print the OpenCL devices and leave")
        .rest()
        .value({"--max-memory", "SIZE|auto", "auto",
                "Bound for rendering, e.g. 512M or 4G: pictures that need more are made in bands, "
                "with the same bits; a scene file's buffers, images and meshes have the "
                "same bound; auto: most of what is available"},
               s.max_memory_bytes, parse_bytes)
        .value({"--grid", "X,Y,SLICES_PER_OCTAVE", "16,9,4",
                "Coarse clusters: tiles across and down, slices for each doubling of depth"},
               grid, grid_text)
        .value({"--lanes", "auto|1|2|4|8|16", "auto",
                "Pixels or lights a work-item treats at once; changes no bit of a picture"},
               s.kernels.lanes, parse_lanes)
        .choice({"--math", "", "exact", "How shading kernels compute"}, s.kernels.math)
        .choice({"--light-colors", "", "float", "How shading kernels store lights' colours"},
                s.kernels.light_colors);
}

void check_reflections(const SharedOptions& options) {
    if (!options.shows_environment) throw UsageError("--reflections: only render and view show it");
    if (options.environment.empty()) {
        throw UsageError("--reflections: needs --environment FILE|studio|sky");
    }
    if (is_forward(options.settings.renderer)) {
        throw UsageError("--reflections: needs --renderer deferred or deferred-all");
    }
}

}  // namespace

void add_shared_options(CLI::App& command, SharedOptions& options) {
    add_scene_option(command, options);
    add_picture_options(command, options);
    add_display_options(command, options);
    add_light_options(command, options);
    add_camera_options(command, options.camera);
    add_device_options(command, options);
    OptionBuilder(command, "General")
        .flag("--quiet,-q", options.quiet, "Only warnings and errors on stderr")
        .flag("--verbose,-v", options.verbose, "More on stderr");
}

void begin_command(const SharedOptions& options, bool compares) {
    if (options.quiet && options.verbose) {
        throw UsageError("--quiet and --verbose exclude each other");
    }
    if (options.show_error && !compares) {
        throw UsageError("--show error: needs --reference FILE, which render takes");
    }
    if (options.reflections) check_reflections(options);
    if (options.rig == Rig::swarm && options.lights_given && options.settings.lights.count == 0) {
        throw UsageError("--rig swarm: needs lights, and --lights is 0");
    }
    set_verbosity(options.quiet     ? Verbosity::quiet
                  : options.verbose ? Verbosity::verbose
                                    : Verbosity::normal);
}

std::vector<std::pair<std::string, std::string>> shared_option_texts(SharedOptions options) {
    CLI::App command;
    add_shared_options(command, options);
    std::vector<std::pair<std::string, std::string>> out;
    for (CLI::Option* option : command.get_options()) {
        option->default_str("")->capture_default_str();
        out.emplace_back(option->get_name(), option->get_default_str());
    }
    return out;
}

}  // namespace kilolux
