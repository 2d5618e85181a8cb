// SPDX-License-Identifier: Apache-2.0
#include "present/cli/scene_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/suggest.h"
#include "host/render/plan/settings_check.h"
#include "host/scene/generated/scenes.h"
#include "host/scene/gltf/load_scene.h"
#include "host/scene/lights/bounded_loss.h"
#include "host/scene/lights/built_in_environments.h"
#include "host/scene/lights/light_tree.h"
#include "present/cli/commit.h"
#include "present/cli/names.h"
#include "present/cli/progress.h"
#include "present/image/image_file.h"
#include "present/image/prefiltered_cache.h"

namespace kilolux {
namespace {

// Whether the extension is that of a picture.
bool is_picture(const std::filesystem::path& file) {
    std::vector<std::string> extensions = image_extensions();
    extensions.insert(extensions.end(), {".bmp", ".webp", ".gif"});
    return std::ranges::count(extensions, lower(file.extension().string())) > 0;
}

// Whether the extension is that of a scene in another format than glTF.
bool is_other_scene(const std::filesystem::path& file) {
    static const std::set<std::string> extensions = {
        ".3ds", ".abc", ".blend", ".c4d", ".dae",  ".fbx",  ".ma",   ".max", ".mb",
        ".obj", ".ply", ".stl",   ".usd", ".usda", ".usdc", ".usdz", ".x3d"};
    return extensions.contains(lower(file.extension().string()));
}

// The file that a name stands for, if it is not a generated scene's.
std::filesystem::path scene_file(const std::string& name_or_file) {
    std::filesystem::path file(name_or_file);
    if (std::filesystem::is_directory(file)) {
        throw Error(name_or_file + ": is a folder, not a scene file");
    }
    const bool named_as_file = file.has_extension() || file.has_parent_path();
    if (!std::filesystem::exists(file) && !named_as_file) {
        const std::vector<std::string> names = generated_scene_names();
        throw UsageError(fmt::format("scene '{}' is no file, and none of {}{}", name_or_file,
                                     joined(names), did_you_mean(name_or_file, names)));
    }
    if (is_picture(file)) {
        throw UsageError(
            fmt::format("scene '{}' is a picture; a scene is a .gltf or .glb file, or one of {} "
                        "(--output names the picture to write)",
                        name_or_file, joined(generated_scene_names())));
    }
    if (is_other_scene(file)) {
        throw UsageError(fmt::format(
            "scene '{}' is a {} file; a scene is a .gltf or .glb file: export it as glTF 2.0",
            name_or_file, file.extension().string()));
    }
    if (!std::filesystem::exists(file)) throw Error(name_or_file + ": no such scene file");
    return file;
}

// Throws for options that only scene files have a use for.
void check_generated(const SharedOptions& options) {
    const std::string is_generated = ": " + options.scene + " is a generated scene, without ";
    if (!options.load.clips.empty()) throw UsageError("--clip" + is_generated + "animations");
    if (!options.load.variant.empty()) throw UsageError("--variant" + is_generated + "variants");
}

// Whether the command line has options of generated lights.
bool asks_for_swarm(const SharedOptions& options) {
    LightOptions standard;
    standard.count = options.settings.lights.count;
    const bool shaped = options.settings.lights != standard;
    return options.lights_given ? standard.count > 0 : shaped;
}

Rig rig_of(const SharedOptions& options, const Scene& scene) {
    if (options.rig != Rig::automatic) return options.rig;
    if (asks_for_swarm(options)) return Rig::swarm;
    if (!options.environment.empty()) return Rig::none;
    return options.lights_given ? Rig::none
                                : automatic_rig(scene, is_generated_scene(options.scene));
}

// How the scene is seen and why, where its own cameras do not decide that.
std::string view_line(const SharedOptions& options, const AnimatedScene& scene) {
    const SeenFrom asked = options.camera.view;
    const bool open =
        !is_generated_scene(options.scene) && is_framed(options.camera, scene.scene());
    if (!open && asked == SeenFrom::automatic) return "";
    const SeenFrom from =
        scene.scene().kind == SceneKind::interior ? SeenFrom::inside : SeenFrom::outside;
    if (asked != SeenFrom::automatic) return fmt::format("view    {} (--view)\n", name_of(from));
    return fmt::format("view    {} (automatic): {}\n", name_of(from), scene.enclosure().reason);
}

// Why an automatic rig is that of an interior or of an object, where no line of the view says it.
std::string rig_reason(const SharedOptions& options, const AnimatedScene& scene) {
    const bool decides = scene.scene().lights.empty() && options.environment.empty() &&
                         !options.lights_given && !asks_for_swarm(options);
    if (!decides || options.rig != Rig::automatic || is_generated_scene(options.scene) ||
        !view_line(options, scene).empty()) {
        return "";
    }
    const bool interior = scene.scene().kind == SceneKind::interior;
    return fmt::format(", as the scene is {}: {}", interior ? "an interior" : "an object",
                       scene.enclosure().reason);
}

// Whether emissive surfaces are lights beside the others that the scene has now.
bool surfaces_light(const SharedOptions& options, const Scene& scene) {
    if (options.emissive_lights != EmissiveLights::automatic) {
        return options.emissive_lights == EmissiveLights::on;
    }
    return std::ranges::all_of(scene.lights, &SceneLight::of_surface) &&
           options.settings.lights.count == 0 && !options.maps &&
           take_area_lights(options.settings);
}

// What glows; empty where nothing does.
std::string glow_line(const SharedOptions& options, const AnimatedScene& scene) {
    if (scene.glow() == nullptr || scene.glow()->meshes == 0) return "";
    const bool automatic = options.emissive_lights == EmissiveLights::automatic;
    return fmt::format("\nglow    {}{}", automatic ? "(automatic) " : "", text_of(*scene.glow()));
}

std::string rig_line(Rig rig, bool automatic, const RenderSettings& settings, std::size_t own) {
    std::string line = fmt::format("rig     {}{}: ", name_of(rig), automatic ? " (automatic)" : "");
    if (const std::size_t count = rig_lights(rig).size(); count > 0) {
        line += fmt::format("{} directional, ", count);
    }
    if (const std::uint64_t count = settings.lights.count; count > 0) {
        line += fmt::format("{} generated and ", count);
    }
    return line + fmt::format("{} of the scene's own lights, ambient {}", own, settings.ambient);
}

// How lights without a range are treated; empty where there are none.
std::string tails_line(const Scene& scene, const RenderSettings& settings, bool automatic) {
    const auto unranged = std::ranges::count_if(scene.lights, lacks_range);
    if (unranged == 0) return "";
    const Tails tails = tails_for(scene.lights, settings.tails, settings.range_budget);
    std::string line = fmt::format("\ntails   {}{}: {} lights without a range ", name_of(tails),
                                   automatic ? " (automatic)" : "", unranged);
    if (tails == Tails::exact) return line + "reach every pixel";
    if (tails == Tails::tree) {
        return line + fmt::format(
                          "reach every pixel, {} of them in groups that err by {} at most: --aov "
                          "error-bound",
                          std::ranges::count_if(scene.lights, is_for_tree), settings.tree_share);
    }
    if (tails == Tails::bounded) {
        return line + fmt::format(
                          "end where each adds {:.3g} of radiance; their sum loses up to about "
                          "{:.0f} % at a point (--aov error-bound), with --tails exact nothing",
                          settings.range_budget,
                          100.0 * bounded_loss(mixed_lights(scene, settings.light_mix),
                                               resting_bounds(scene), settings.range_budget));
    }
    return line + fmt::format(
                      "have random ones, at least to where each adds {:.3g} of radiance: "
                      "right in the mean of --samples",
                      settings.range_budget);
}

// Sets options.shown_background, too.
std::string add_environment(SharedOptions& options, AnimatedScene& scene) {
    using Kind = BackgroundChoice::Kind;
    const BackgroundChoice& background = options.background;
    if (background.kind == Kind::color) {
        options.shown_background = std::make_shared<const Environment>(
            Environment{1, 1, {background.color}, background.as_shown});
    }
    if (options.environment.empty()) return "";
    check_environment(options.environment);
    Environment environment =
        environment_of(options.environment, options.settings.max_memory_bytes);
    std::string line = fmt::format("; environment {}: ", options.environment);
    if (options.reflections) {
        options.maps =
            std::make_shared<const PrefilteredEnvironment>(kept_prefiltered(environment, commit()));
        line += "prefiltered";
    } else {
        const auto lights =
            environment_lights(environment, static_cast<std::size_t>(options.environment_lights));
        scene.add_lights(lights);
        line += fmt::format("{} directional", lights.size());
    }
    if (background.kind == Kind::environment) {
        options.shown_background = std::make_shared<const Environment>(std::move(environment));
    }
    return line;
}

// Metal reflects its surroundings: a studio of few lights leaves it dark.
bool wants_reflections(const SharedOptions& options, const Scene& scene) {
    constexpr double kMostly = 0.5;
    return options.shows_environment && !options.ambient_given &&
           options.settings.shading != Shading::illuminance &&
           !is_forward(options.settings.renderer) && metallic_share(scene) > kMostly;
}

// Replaces the studio's lights by the studio's room.
void reflect_studio(SharedOptions& options) {
    options.environment = "studio";
    options.reflections = true;
    if (options.background.kind == BackgroundChoice::Kind::environment) {
        options.background.kind = BackgroundChoice::Kind::none;
    }
}

// Colours of unlit materials are meant as they are: no curve shifts them.
std::string choose_tone_curve(SharedOptions& options, const Scene& scene) {
    const bool is_unlit = std::ranges::all_of(scene.instances, [&](const Instance& instance) {
        return material_of(scene, scene.meshes[static_cast<std::size_t>(instance.mesh)]).unlit;
    });
    const bool shows_light = scene.instances.empty() || !options.environment.empty();
    if (options.tone_curve_given || !is_unlit || shows_light) return "";
    options.settings.tone_curve = ToneCurve::none;
    return "\ntonemap none (automatic): all surfaces are unlit";
}

}  // namespace

void check_scene(const std::string& name_or_file) {
    if (!is_generated_scene(name_or_file)) scene_file(name_or_file);
}

void check_environment(const std::string& name) {
    const std::filesystem::path file(name);
    if (name.empty() || is_built_in_environment(name) || std::filesystem::exists(file)) return;
    if (file.has_extension() || file.has_parent_path()) {
        throw Error(name + ": no such environment file");
    }
    const std::vector<std::string>& built_in = built_in_environment_names();
    throw UsageError(fmt::format("--environment '{}' is no file, and none of {}{}", name,
                                 joined(built_in), did_you_mean(name, built_in)));
}

AnimatedScene open_animated_scene(const SharedOptions& options) {
    if (is_generated_scene(options.scene)) {
        check_generated(options);
        return AnimatedScene(make_generated_scene(options.scene));
    }
    std::optional<Progress> bar;
    LoadOptions load = options.load;
    load.time = options.time;
    const RenderSettings& settings = options.settings;
    load.max_memory_bytes =
        settings.memory_shares > 1 ? memory_limit(settings) : settings.max_memory_bytes;
    return AnimatedScene(scene_file(options.scene), load, [&](std::size_t done, std::size_t total) {
        if (!bar)
            bar.emplace("loading images", total, progress_kind_of_part(options.shown_progress()));
        if (done > 0) bar->advance();
    });
}

std::string light_scene(SharedOptions& options, AnimatedScene& scene) {
    scene.see_from(options.camera.view);
    scene.light_by_surfaces(false);
    const bool automatic = options.rig == Rig::automatic;
    Rig rig = rig_of(options, scene.scene());
    const std::string reason = rig_reason(options, scene);
    const bool metal = automatic && rig == Rig::studio && wants_reflections(options, scene.scene());
    if (metal) {
        reflect_studio(options);
        rig = Rig::none;
    }
    const std::size_t own = scene.scene().lights.size();
    const bool has_swarm =
        options.environment.empty() &&
        automatic_rig(scene.scene(), is_generated_scene(options.scene)) == Rig::swarm;
    scene.add_lights(rig_lights(rig));
    const std::string from_around = add_environment(options, scene);
    std::uint64_t& generated = options.settings.lights.count;
    if (rig != Rig::swarm && !options.lights_given) generated = 0;
    float& ambient = options.settings.ambient;
    if (!options.ambient_given) {
        ambient = rig_ambient(rig, options.environment.empty() ? ambient : 0.0f);
    }
    choose_emissive_lights(options, scene);
    choose_light_groups(options, scene.scene());
    const bool finds_tails = options.settings.tails == Tails::automatic;
    choose_tails(options, scene.scene());
    // The rig option stays automatic if the automatic rig has the swarm: a copied command then
    // needs no --rig.
    options.rig = rig == Rig::swarm && has_swarm ? Rig::automatic : rig;
    return view_line(options, scene) + rig_line(rig, automatic, options.settings, own) + reason +
           from_around + (metal ? " (a studio's room, as most of the surface is metal)" : "") +
           glow_line(options, scene) + tails_line(scene.scene(), options.settings, finds_tails) +
           choose_tone_curve(options, scene.scene());
}

void choose_emissive_lights(const SharedOptions& options, AnimatedScene& scene) {
    scene.light_by_surfaces(surfaces_light(options, scene.scene()));
}

void choose_light_groups(SharedOptions& options, const Scene& scene) {
    RenderSettings& s = options.settings;
    s.light_mix.groups = light_groups_of(scene, s.lights, options.light_groups);
    check_light_mix(s.light_mix);
    const bool has_layers = options.takes_light_layers && !options.no_light_layers;
    s.light_groups = has_layers ? s.light_mix.groups : std::vector<LightGroup>();
}

void choose_tails(SharedOptions& options, const Scene& scene) {
    RenderSettings& s = options.settings;
    const bool bounded = tails_for(scene.lights, s.tails, s.range_budget) == Tails::bounded;
    if (s.tails != Tails::automatic || !bounded || s.range_budget != kDefaultRangeBudget) return;
    const std::vector<SceneLight> lights = mixed_lights(scene, s.light_mix);
    if (bounded_loss(lights, resting_bounds(scene), s.range_budget) <= kMostLost) return;
    // What a tree does not hold reaches every pixel.
    const auto unranged = std::ranges::count_if(scene.lights, lacks_range);
    const auto outside = unranged - std::ranges::count_if(scene.lights, is_for_tree);
    const bool takes_tree = !options.compares_renderers && tree_can_light(scene, s) &&
                            static_cast<std::size_t>(outside) <= kExactTails;
    if (takes_tree) {
        s.tails = Tails::tree;
        return;
    }
    s.tails = Tails::bounded;
    s.range_budget = budget_of_sum(lights, resting_bounds(scene), s.range_budget);
    const double lost = bounded_loss(lights, resting_bounds(scene), s.range_budget);
    if (lost <= kMostLost) return;
    warn(fmt::format(
        "{}: lights without a range are cut off; up to about {:.0f} % of their light is lost at a "
        "point; --tails exact keeps it",
        options.scene, 100.0 * lost));
}

void measure_swarm(SharedOptions& options) {
    const bool without = options.lights_given && options.settings.lights.count == 0;
    if (options.rig == Rig::automatic && !without) options.rig = Rig::swarm;
}

Scene open_scene(SharedOptions& options) {
    AnimatedScene scene = open_animated_scene(options);
    note(light_scene(options, scene));
    return std::move(scene).take();
}

Camera choose_camera(const SharedOptions& options, const Scene& scene) {
    const RenderSettings& s = options.settings;
    return choose_camera(options.camera, scene, static_cast<double>(s.width) / s.height);
}

}  // namespace kilolux
