// SPDX-License-Identifier: Apache-2.0
#include "present/commands/photometry/photometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <numbers>
#include <utility>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/atomic_write.h"
#include "host/base/system/interrupt.h"
#include "host/base/text.h"
#include "host/measure/photometry/point_lighting.h"
#include "host/scene/generated/scenes.h"
#include "host/scene/lights/built_in_environments.h"
#include "host/scene/lights/environment.h"
#include "host/scene/lights/light_generator.h"
#include "present/cli/option_builder.h"
#include "present/cli/scene_choice.h"
#include "present/cli/stats_json.h"
#include "present/commands/photometry/illuminance_report.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Of long work on all cores.
void stop_if_interrupted(double) { check_interrupt(); }

enum class ResultFormat { csv, json };

ResultFormat result_format(const fs::path& file) {
    const std::string extension = lower(file.extension().string());
    if (extension == ".csv") return ResultFormat::csv;
    if (extension == ".json") return ResultFormat::json;
    throw UsageError(fmt::format("--output: '{}': result type '{}' is none of .csv, .json",
                                 file.string(), extension));
}

std::string result_file(const std::string&, const std::string& text) {
    result_format(text);
    return text;
}

// Refuses options that photometry ignores. Turns the automatic rig off where the scene has lights.
void settle_options(PhotometryOptions& options) {
    SharedOptions& shared = options.shared;
    refuse_if(options.points.empty() == (options.plane.columns == 0),
              "photometry: needs one of --points FILE.csv and --plane");
    refuse_if(shared.settings.shadows != Shadows::off,
              "--shadows: photometry has none; every light reaches every point");
    Tails& tails = shared.settings.tails;
    refuse_if(tails != Tails::automatic && tails != Tails::exact,
              "--tails: in photometry lights without a range reach every point");
    tails = Tails::exact;
    const bool has_own_light = !is_generated_scene(shared.scene) || !shared.environment.empty();
    if (shared.rig == Rig::automatic && !shared.lights_given && has_own_light) {
        shared.rig = Rig::none;
    }
}

// Leaves out lights that cannot be used; returns the others' numbers.
std::vector<std::size_t> keep_usable(std::vector<SceneLight>& lights, const std::string& scene) {
    std::vector<SceneLight> ranged = lights;
    fill_missing_ranges(ranged, Tails::exact);
    std::vector<SceneLight> kept;
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (!is_usable(ranged[i], glm::dvec3(0.0))) continue;
        kept.push_back(lights[i]);
        numbers.push_back(i);
    }
    if (kept.size() < lights.size()) {
        warn(
            fmt::format("{}: {} unusable lights are left out", scene, lights.size() - kept.size()));
    }
    lights = std::move(kept);
    return numbers;
}

// The scene at its time with all of its lights, in the world.
LitScene lit_scene(SharedOptions& shared) {
    Scene scene = open_scene(shared);
    const Camera camera = choose_camera(shared, scene);
    const GroupMix& mix = shared.settings.light_mix;
    const auto generated =
        generate_lights(mixed_generated(shared.settings.lights, scene, mix), scene, shared.time);
    scene.lights = mixed_lights(scene, mix);
    scene.lights.insert(scene.lights.end(), generated.begin(), generated.end());
    for (SceneLight& light : scene.lights) {
        light = placed_light(light, camera.world_from_view, camera.position);
        light.follows_camera = false;
    }
    std::vector<std::size_t> numbers = keep_usable(scene.lights, shared.scene);
    return {std::move(scene), std::move(numbers)};
}

// Takes the environment's light out of the options, as directional lights: it is counted apart, not
// among the scene's.
Scene take_environment(SharedOptions& shared) {
    Scene out;
    const std::string environment = std::exchange(shared.environment, "");
    if (environment.empty()) return out;
    out.lights = environment_lights(environment_of(environment, shared.settings.max_memory_bytes),
                                    static_cast<std::size_t>(shared.environment_lights));
    // As in a picture: where something else lights, emissive surfaces do when they are asked to.
    if (!out.lights.empty() && shared.emissive_lights == EmissiveLights::automatic) {
        shared.emissive_lights = EmissiveLights::off;
    }
    return out;
}

// The environment's light on each point [lx]; empty without one.
std::vector<double> environment_lux(const Scene& around,
                                    const std::vector<MeasuringPoint>& points) {
    if (around.lights.empty()) return {};
    const ExactLighting lighting(around);
    std::vector<double> out(points.size());
    const auto light_group = [&](int group) {
        const std::size_t first = static_cast<std::size_t>(group) * kGroupPoints;
        for (std::size_t i = first; i < std::min(first + kGroupPoints, points.size()); ++i) {
            out[i] = lighting.at(points[i]).lux;
        }
    };
    parallel_rows(static_cast<int>((points.size() + kGroupPoints - 1) / kGroupPoints), light_group,
                  stop_if_interrupted);
    return out;
}

// Numbers of the points that float64 computes, evenly among all.
std::vector<std::size_t> float64_indices(const PhotometryOptions& options, std::size_t points,
                                         double work) {
    constexpr double kAutomaticWork = 3e7;  // about a second on two cores
    const double automatic = std::max(1.0, kAutomaticWork / work);
    const double asked =
        options.exact_points ? static_cast<double>(*options.exact_points) : automatic;
    const auto count = static_cast<std::size_t>(std::min(asked, static_cast<double>(points)));
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < count; ++k) out.push_back(k * points / count);
    return out;
}

Illuminances measured(const PhotometryOptions& options, std::vector<MeasuringPoint> points,
                      const Scene& scene, const Scene& around) {
    Illuminances out;
    out.points = std::move(points);
    const SharedOptions& shared = options.shared;
    PointLighting kernels(scene, shared.settings);
    auto start = std::chrono::steady_clock::now();
    const std::vector<std::uint32_t> order = order_in_groups(out.points);
    out.kernels = kernels.illuminance(out.points, order);
    const double kernel_s = seconds_since(start);
    check_interrupt();
    start = std::chrono::steady_clock::now();
    const ExactLighting exact(scene);
    out.float64_indices = float64_indices(options, out.points.size(), exact.work());
    out.exact = exact_illuminance(exact, out.points, out.float64_indices, stop_if_interrupted);
    note(fmt::format("lit     {} points by {} in {:.2g} s, {} of them in float64 in {:.2g} s",
                     out.points.size(), kernels.device().name, kernel_s, out.exact.size(),
                     seconds_since(start)));
    out.range_loss = range_loss_bounds(scene, out.points, order, stop_if_interrupted);
    for (std::size_t k = 0; k < out.exact.size(); ++k) {
        out.range_loss[out.float64_indices[k]] = out.exact[k].range_loss;
    }
    out.environment = environment_lux(around, out.points);
    // Radiance from everywhere arrives as pi times it.
    if (shared.ambient_given) out.ambient = std::numbers::pi * double{shared.settings.ambient};
    return out;
}

// In parts: the cells of all points at once would take many times the points' memory.
void write_csv(const fs::path& file, const Illuminances& result, const LitScene& lit) {
    constexpr std::size_t kPart = 4096;  // points
    AtomicFile out(file);
    for (std::size_t first = 0; first < result.points.size(); first += kPart) {
        check_interrupt();
        const std::size_t end = std::min(first + kPart, result.points.size());
        const std::string text = to_csv(illuminance_table(result, lit, first, end));
        out.write(std::string_view(text).substr(first == 0 ? 0 : text.find('\n') + 1));
    }
    out.commit();
}

void write_result(const fs::path& file, const Illuminances& result, const LitScene& lit) {
    if (result_format(file) == ResultFormat::json) {
        write_json(file.string(), illuminance_json(result, lit));
    } else {
        write_csv(file, result, lit);
    }
}

void run_photometry(PhotometryOptions& options) {
    begin_command(options.shared);
    settle_options(options);
    if (!options.output.empty()) check_can_write(options.output);
    std::vector<MeasuringPoint> points =
        options.points.empty() ? points_of(options.plane) : read_points(options.points);
    const Scene around = take_environment(options.shared);
    const LitScene lit = lit_scene(options.shared);
    if (lit.scene.lights.empty() && around.lights.empty()) {
        throw Error(options.shared.scene + ": has no lights to measure; --lights N adds some");
    }
    const Illuminances result = measured(options, std::move(points), lit.scene, around);
    if (!options.output.empty()) write_result(options.output, result, lit);
    const auto document = options.json ? illuminance_json(result, lit) : nlohmann::ordered_json();
    print_result(options.json, document, illuminance_text(result, lit));
    if (!options.output.empty()) note("wrote   " + options.output.string());
}

constexpr const char* kPhotometryExamples =
    "  kilolux photometry street.glb --plane 0,0,40,7,0,20,5\n"
    "  kilolux photometry hall.glb --points desks.csv -o desks_lux.csv\n"
    "  kilolux photometry hall.glb --plane 0,3,0,4,0,0,0,-3,0,40,30 --json";

}  // namespace

void visit_settings(PhotometryOptions& options, const SettingVisitor& f) {
    visit_settings(options.shared, f);
    OptionBuilder(f, "Points and output")
        .input_file(
            {"--points", "FILE", "",
             "CSV with a point a line: x,y,z,nx,ny,nz, position in metres and the normal of "
             "the surface that is lit; a first line of these names is left out"},
            options.points)
        .value({"--plane", "NUMBERS", "", kPlaneSyntax}, options.plane, parse_plane)
        .count({"--exact-points", "N", "a second's work",
                "Points that float64 computes, too, evenly among all: their error of the kernels "
                "and their largest contributors are known",
                kNeither, "1"},
               options.exact_points, {0, std::uint64_t{1} << 27})
        .value({"--output,-o", "FILE", "", "All points: .csv or .json"}, options.output,
               result_file)
        .flag("--json", options.json, "JSON instead of text on standard output");
}

void add_photometry_options(CLI::App& command, PhotometryOptions& options) {
    add_options(command, options);
    leave_to_help_all(command, {"--renderer", "--resolution", "--samples", "--show", "--aov",
                                "--gbuffer", "--shading", "--exposure", "--tonemap", "--bloom",
                                "--shadows", "--shadow-rays", "--background", "--reflections"});
}

void add_photometry_command(Program& program) {
    program.add_command("photometry", "Measure the illuminance of points, in lux",
                        kPhotometryExamples, add_photometry_options, run_photometry);
}

}  // namespace kilolux
