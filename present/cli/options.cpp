// SPDX-License-Identifier: Apache-2.0
// The table of the shared options, a row each.
#include "present/cli/options.h"

#include <fmt/format.h>
#include <tuple>

#include "host/base/log.h"
#include "host/base/text.h"
#include "host/render/plan/settings_check.h"
#include "host/scene/generated/scenes.h"
#include "host/scene/lights/built_in_environments.h"
#include "present/cli/option_builder.h"
#include "present/cli/picture_settings.h"
#include "present/cli/scene_choice.h"

namespace kilolux {
namespace {

void check_reflections(const SharedOptions& options) {
    refuse_if(!options.shows_environment, "--reflections: only render and view show it");
    refuse_if(options.environment.empty(), "--reflections: needs --environment FILE|studio|sky");
    refuse_if(is_forward(options.settings.renderer),
              "--reflections: needs --renderer deferred or deferred-all");
}

// A new member does not compile here: add a row below, then its name. Members without a row are set
// elsewhere: by the renderer (opened, background, reflections), by tests (force_features,
// band_rows, kernels.chunks, kernels.group_height), by the scene (groups), by mixed_generated()
// (lights.gain), and by the window and the commands (grid.fine_per_octave, memory_shares,
// device_shares and the rest of want).
void count_members(SharedOptions& options) {
    [[maybe_unused]] auto& [scene, load, settings, rig, emissive_lights, light_groups,
                            no_light_layers, takes_light_layers, environment, background,
                            shown_background, reflections, maps, shows_environment,
                            compares_renderers, environment_lights, lights_given, ambient_given,
                            tone_curve_given, shadow_rays_given, takes_automatic_exposure,
                            automatic_exposure, takes_automatic_samples, camera, time, show_error,
                            progress, quiet, verbose] = options;
    [[maybe_unused]] auto& [load_time, allow_outside_paths, load_memory, clips, variant, strict,
                            line_width, light_size] = load;
    [[maybe_unused]] auto& [renderer, width, height, lights, tails, range_budget, seed, tree_share,
                            gbuffer, geometry, anisotropy, no_reuse, shading, shadows,
                            opaque_shadows, shadow_rays, ambient, backdrop, mirrored, bloom,
                            exposure, tone_curve, samples, auto_samples, want, groups, mix, grid,
                            kernels, force_features, max_memory_bytes, memory_shares, device_shares,
                            band_rows, device, opened] = settings;
    [[maybe_unused]] auto& [count, light_seed, radius, intensity, size, box, gain] = lights;
    [[maybe_unused]] auto& [on, error, most] = auto_samples;
    [[maybe_unused]] auto& [display, radiance, shown_light, counts, shadow_counts, view, aovs,
                            layer, probes, strip_makers, crop_pixels] = want;
    [[maybe_unused]] auto& [tiles_x, tiles_y, slices_per_octave, fine_per_octave] = grid;
    [[maybe_unused]] auto& [lanes, group_height, chunks, math, light_colors] = kernels;
    [[maybe_unused]] auto& [index, framed, view_from, fit, position, focal_point, view_up,
                            view_angle, orthographic] = camera;
}

void visit_scene(const SettingVisitor& f, SharedOptions& o) {
    OptionBuilder(f, "Scene")
        .input_file({"SCENE", "", "",
                     "A generated scene (" + joined(generated_scene_names()) +
                         ") or a glTF 2.0 file, .gltf or .glb",
                     kPicture},
                    o.scene, generated_scene_names())
        .value({"--clip", "NAME-OR-INDEX[,...]", "the file's first",
                "Animations of the file that play, as info lists them; also all or none", kPicture},
               o.load.clips, parse_list)
        .text({"--variant", "NAME-OR-INDEX", "the file's own",
               "Variant of the file's materials, as info lists them", kPicture},
              o.load.variant)
        .flag("--strict", o.load.strict,
              "Refuse a file that has anything that the picture would lack; else a warning says "
              "so")
        .choice({"--view", "", "",
                 "From where the scene is seen and how it is lit; inside and outside mean the "
                 "automatic camera, unless there is --camera-index I",
                 kPicture},
                o.camera.view)
        .rest()
        .value({"--line-width", "METRES|PERCENT%", "",
                "Width of points and lines: a share of the scene's diagonal, or metres", kPicture},
               o.load.line_width, parse_line_width)
        .flag("--allow-outside-paths", o.load.allow_outside_paths,
              "Let the file name buffers and images outside its folder");
}

void visit_lights(const SettingVisitor& f, SharedOptions& o) {
    LightOptions& l = o.settings.lights;
    const auto take_count = [&o](const std::string& name, const std::string& text) {
        o.settings.lights.count = parse_count(name, text, kLightsRange);
        o.lights_given = true;
    };
    OptionBuilder(f, "Lights, added to the file's own")
        .choice({"--rig", "", "", "What lights the scene", kPanelPicture}, o.rig)
        .value(SettingKind::count,
               {"--lights", "N", text_of(l.count) + " with the rig swarm",
                "Generated point lights, e.g. 20k or 1e6, beside any rig; without --rig they are "
                "the rig, and 0 keeps only the file's own",
                kPanelPicture, "1"},
               take_count, [&l] { return text_of(l.count); })
        .count({"--light-seed", "S", "", "Decides places, colours and motion", kPanelPicture, "1"},
               l.seed, kLightSeedRange)
        .number_or_auto({"--light-radius", "R|auto", "", "Range; beyond it a light is exactly 0",
                         kPanelPicture, "m"},
                        l.radius, kAboveZeroRange)
        .number_or_auto(
            {"--light-intensity", "I|auto", "", "Brightest channel", kPanelPicture, "cd"},
            l.intensity, kAboveZeroRange)
        .input_file(
            {"--environment", "FILE|studio|sky", "",
             "Light from all around: an image, longitude by latitude, its middle towards -Z, e.g. "
             ".hdr or .exr; studio: soft boxes in a dim room; sky: a clear sky with a sun. Then "
             "--rig auto is none and --ambient 0",
             kPicture},
            o.environment, built_in_environment_names());
}

void visit_more_lights(const SettingVisitor& f, SharedOptions& o) {
    RenderSettings& s = o.settings;
    const auto take_size = [&o](const std::string& name, const std::string& text) {
        o.load.light_size = o.settings.lights.size = parse_number(name, text, kZeroOrAboveRange);
    };
    OptionBuilder(f, "Lights, added to the file's own")
        .rest()
        .flag("--reflections", o.reflections,
              "Light surfaces by prefiltered maps of the environment (split sum) in place of "
              "lights, so that shiny metals reflect it; render and view; no forward "
              "renderers",
              kPicture)
        .count({"--environment-lights", "N", "", "Directional lights that stand for it", kPicture,
                "1"},
               o.environment_lights, {1, 65536})
        .value(SettingKind::number,
               {"--light-size", "R", "",
                "Radius of generated points, and of the file's points that give none; they become "
                "spheres of the same intensity",
                kPanelPicture, "m"},
               take_size, [&s] { return text_of(s.lights.size); })
        .choice({"--emissive-lights", "", "",
                 "Whether emissive surfaces light the others, each triangle as a light with its "
                 "mean emission",
                 kPanelPicture},
                o.emissive_lights)
        .value({"--light-box", "X0,Y0,Z0,X1,Y1,Z1", "the scene's", "Where they are", kPicture, "m"},
               s.lights.box, parse_box)
        .choice({"--tails", "", "", "Where the file's lights without a range end", kPanelPicture},
                s.tails)
        .number({"--range-budget", "E", "", "Radiance at which a bounded light ends", kPicture,
                 "cd/m2"},
                s.range_budget, kAboveZeroRange)
        .number({"--tree-share", "S", "",
                 "Largest error of a group of a tree, as a share of the light that it sends",
                 kPanelPicture, "1"},
                s.tree_share, kShareRange);
}

void visit_camera(const SettingVisitor& f, CameraChoice& c) {
    const auto take_index = [&c](const std::string& name, const std::string& text) {
        c.framed = text == "auto";
        c.index.reset();
        if (!c.framed) c.index = static_cast<int>(parse_count(name, text, {0, 0x7fffffff}));
    };
    OptionBuilder(f, "Camera")
        .value(SettingKind::count,
               {"--camera-index", "I|auto", "the first, else auto",
                "A camera of the scene, from 0; auto: one that sees the scene as --view says",
                kPicture, "1"},
               take_index, [&c] { return c.framed ? std::string("auto") : text_of(c.index); })
        .value({"--camera-position", "X,Y,Z", "", "Where it stands", kPicture, "m"}, c.position,
               parse_vector)
        .value({"--camera-focal-point", "X,Y,Z", "",
                "What it looks at; with a position alone: the scene's middle", kPicture, "m"},
               c.focal_point, parse_vector)
        .rest()
        .value({"--camera-view-up", "X,Y,Z", "0,1,0", "What is up in the picture", kPicture, "1"},
               c.view_up, parse_vector)
        .number({"--camera-view-angle", "DEG", "the camera's, else 45", "Vertical angle", kPicture,
                 "degrees"},
                c.view_angle, {0.0, 180.0, true})
        .choice({"--fit", "", "",
                 "What a picture of another shape keeps of a file's camera that has an aspect",
                 kPicture},
                c.fit)
        .flag("--camera-orthographic", c.orthographic, "Parallel projection", kPicture);
}

void visit_device(const SettingVisitor& f, RenderSettings& s) {
    const auto grid = [&s](const std::string& name, const std::string& text) {
        std::tie(s.grid.tiles_x, s.grid.tiles_y, s.grid.slices_per_octave) =
            std::tuple_cat(parse_grid(name, text));
    };
    const auto grid_text = [&s] {
        return fmt::format("{},{},{}", s.grid.tiles_x, s.grid.tiles_y, s.grid.slices_per_octave);
    };
    OptionBuilder(f, "Device")
        .text({"--device", "NAME-OR-INDEX", "best",
               "OpenCL device; also all, or indices by commas: they share render's frames or rows, "
               "and the errors of report's settings, whose times are those of the first; 0,0: two "
               "frames of a sequence at once on device 0"},
              s.device)
        .rest()
        .value({"--max-memory", "SIZE|auto", "",
                "Bound for rendering, e.g. 512M or 4G: pictures that need more are made in bands, "
                "with the same bits; a scene file's buffers, images and meshes have the "
                "same bound; auto: most of what is available",
                kTime, "bytes"},
               s.max_memory_bytes, parse_bytes,
               [&s] { return s.max_memory_bytes == 0 ? "auto" : text_of(s.max_memory_bytes); })
        .value(SettingKind::numbers,
               {"--grid", "X,Y,SLICES_PER_OCTAVE", "",
                "Coarse clusters: tiles across and down, slices for each doubling of depth",
                kPanelPicture, "1"},
               grid, grid_text)
        .value({"--lanes", "auto|1|2|4|8|16", "",
                "Pixels or lights a work-item treats at once; changes no bit on CPUs", kPanelTime,
                "1"},
               s.kernels.lanes, parse_lanes,
               [&s] { return s.kernels.lanes == 0 ? "auto" : text_of(s.kernels.lanes); })
        .choice({"--math", "", "", "How shading kernels compute", kPicture}, s.kernels.math)
        .choice({"--light-colors", "", "", "How shading kernels store lights' colours", kPicture},
                s.kernels.light_colors);
}

}  // namespace

void begin_command(const SharedOptions& options, bool compares) {
    refuse_if(options.quiet && options.verbose, "--quiet and --verbose exclude each other");
    refuse_if(options.show_error && !compares,
              "--show error: needs --reference FILE, which render takes");
    check_settings(options.settings);
    if (options.reflections) check_reflections(options);
    check_environment(options.environment);
    refuse_if(
        options.rig == Rig::swarm && options.lights_given && options.settings.lights.count == 0,
        "--rig swarm: needs lights, and --lights is 0");
    set_verbosity(options.quiet     ? Verbosity::quiet
                  : options.verbose ? Verbosity::verbose
                                    : Verbosity::normal);
}

std::string option_words(const std::vector<Setting>& settings, const std::vector<Setting>& defaults,
                         Changes least) {
    const auto differs = [&](std::size_t i) { return settings[i].show() != defaults[i].show(); };
    // The default number of lights and the default ambient light hold for some rigs only.
    bool has_own_rig = false;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        has_own_rig = has_own_rig || (settings[i].option() == "--rig" && differs(i));
    }
    std::string out;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const Setting& setting = settings[i];
        const std::string name = setting.option();
        const bool of_rig = has_own_rig && (name == "--lights" || name == "--ambient");
        const bool is_said = (differs(i) || of_rig) && setting.text.effect.changes >= least;
        if (!is_said || name == "SCENE" || setting.heading == "General") continue;
        out += " " + name;
        if (setting.kind != SettingKind::flag) out += " " + shell_word(setting.show());
    }
    return out;
}

void visit_settings(SharedOptions& options, const SettingVisitor& f) {
    count_members(options);
    visit_scene(f, options);
    visit_picture_settings(options, f);
    visit_lights(f, options);
    visit_more_lights(f, options);
    visit_camera(f, options.camera);
    visit_device(f, options.settings);
    OptionBuilder(f, "General")
        .choice({"--progress", "", "", "How a job tells how far it is"}, options.progress)
        .flag("--quiet,-q", options.quiet,
              "Only warnings and errors on stderr, and what --progress asks for")
        .flag("--verbose,-v", options.verbose, "More on stderr");
}

}  // namespace kilolux
