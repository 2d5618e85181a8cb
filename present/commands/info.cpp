// SPDX-License-Identifier: Apache-2.0
#include "present/commands/info.h"

#include <fmt/format.h>
#include <algorithm>

#include "host/base/error.h"
#include "host/measure/bench/feature_cost.h"
#include "host/measure/roofline/independent_limits.h"
#include "host/render/plan/kernel_choice.h"
#include "host/render/renderer.h"
#include "host/scene/gltf/files.h"
#include "host/scene/lights/light_kinds.h"
#include "present/cli/option_builder.h"
#include "present/cli/scene_choice.h"
#include "present/cli/stats_json.h"
#include "present/commands/bench/bench.h"
#include "present/commands/bench/bench_context.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Json box_json(const Box& box) {
    if (box.empty()) return nullptr;
    return {{"min", vector_json(box.min)}, {"max", vector_json(box.max)}};
}

Json light_counts(const Scene& scene, const LightOptions& generated) {
    Json out;
    for (const LightKind& kind : kLightKinds)
        out[kind.name] = std::ranges::count(scene.lights, kind.type, &SceneLight::type);
    out["of_surfaces"] = std::ranges::count(scene.lights, true, &SceneLight::of_surface);
    const LightScale scale = automatic_light_scale(generated, scene);
    out["generated"] = generated.count;
    out["generated_range_m"] = scale.radius;
    out["generated_intensity_cd"] = scale.intensity;
    out["min_distance_m"] = light_d_min(scene);
    return out;
}

// A web's flux beside what its file says of it, where it does.
Json profile_json(const PhotometricWeb& web) {
    const double flux = lumens(web);
    Json out{{"name", web.name}, {"peak_cd", web.peak}, {"lumens", flux}};
    if (web.stated_lumens) {
        out["stated_lumens"] = *web.stated_lumens;
        out["difference_percent"] = 100.0 * (flux / *web.stated_lumens - 1.0);
    }
    out["down_share"] = lumens(web, 90.0) / flux;
    if (web.stated_down_share) out["stated_down_share"] = *web.stated_down_share;
    out["table_error"] = web.table_error;
    return out;
}

Json profiles_json(const Scene& scene) {
    Json out = Json::array();
    for (std::size_t i = 0; i < scene.webs.size(); ++i) {
        out.push_back(profile_json(scene.webs[i]));
        out.back()["lights"] = std::ranges::count(scene.aimed_profiles, i, &SceneProfile::web);
    }
    return out;
}

const char* kind_name(SceneKind kind) {
    constexpr const char* kNames[] = {"open", "closed", "interior"};
    return kNames[static_cast<int>(kind)];
}

Json clips_json(const Scene& scene) {
    Json out = Json::array();
    for (const Clip& clip : scene.clips) {
        out.push_back({{"name", clip.name},
                       {"index", out.size()},
                       {"length_s", clip.length},
                       {"channels", clip.channels},
                       {"plays", clip.plays}});
        if (!clip.broken.empty()) out.back()["broken"] = clip.broken;
    }
    return out;
}

Json scene_json(const Scene& scene, const LightOptions& generated) {
    const LightRegion region = automatic_light_scale(generated, scene).region;
    return {{"name", scene.name},
            {"triangles", triangle_count(scene)},
            {"meshes", scene.meshes.size()},
            {"instances", scene.instances.size()},
            {"materials", scene.materials.size()},
            {"textures", scene.textures.size()},
            {"images", scene.images.size()},
            {"cameras", scene.cameras.size()},
            {"animations", clips_json(scene)},
            {"variants", scene.variants},
            {"lights", light_counts(scene, generated)},
            {"light_profiles", profiles_json(scene)},
            {"kind", kind_name(scene.kind)},
            {"bounds", box_json(bounds(scene))},
            {"light_box", box_json(region.outer)},
            {"light_hole", box_json(region.hole)}};
}

// The features that the scene lacks, and with --costs their cost on this picture.
Json left_out_json(const InfoOptions& options, const Scene& scene, const ScenePlan& plan) {
    Json out = Json::array();
    std::vector<FeatureCost> costs = left_out_features(plan);
    if (options.costs) {
        const Camera camera = choose_camera(options.shared, scene);
        LightingBench bench(scene, options.shared.settings, camera, options.shared.time);
        costs = measure_feature_costs(bench);
    }
    for (const FeatureCost& cost : costs) out.push_back(cost_json(cost));
    return out;
}

Json info_json(InfoOptions& options) {
    const Scene scene = open_scene(options.shared);
    const Renderer renderer(scene, options.shared.settings);
    const ScenePlan& plan = renderer.plan();
    Json out;
    out["device"] = device_json(renderer.device());
    out["devices"] = Json::array();
    for (const DeviceInfo& device : list_devices()) out["devices"].push_back(device_json(device));
    out["scene"] = scene_json(scene, options.shared.settings.lights);
    out["plan"] = plan.features;
    out["left_out"] = left_out_json(options, scene, plan);
    out["gbuffer_bytes_per_pixel"] = plan.gbuffer_bytes_per_pixel;
    out["tuning_source"] = text_of(known_tuning(renderer.device()).source);
    out["tuning"] = tuning_json(choose_tuning(renderer.device(), options.shared.settings.kernels));
    const Gpu gpu(choose_device(options.shared.settings.device));
    out["limits"] = limits_json(cached_device_limits(gpu, options.measure_limits));
    return out;
}

// A short form for reading; --json has all digits.
std::string shown_value(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_array()) {
        std::string out;
        for (const Json& entry : value) out += (out.empty() ? "" : ", ") + shown_value(entry);
        return out;
    }
    if (!value.is_number_float()) return value.dump();
    const double number = value;
    return number >= 1e9 ? fmt::format("{:.4g} G", 1e-9 * number) : fmt::format("{:.6g}", number);
}

std::string clip_line(const Json& clip) {
    return fmt::format("{} '{}': {:.6g} s, {} channels{}", clip["index"].get<int>(),
                       shown_uri(clip["name"].get<std::string>()), clip["length_s"].get<double>(),
                       clip["channels"].get<int>(),
                       clip["plays"].get<bool>() ? ", plays"
                       : clip.contains("broken") ? ", broken"
                                                 : "");
}

std::string profile_line(const Json& profile) {
    const auto stated = [&](const char* name, auto&& text) {
        return profile.contains(name) ? text(profile[name].get<double>()) : std::string();
    };
    return fmt::format(
        "'{}': peak {:.6g} cd, {:.6g} lm{}, {:.4g} % of it down{}, {} lights",
        shown_uri(profile["name"].get<std::string>()), profile["peak_cd"].get<double>(),
        profile["lumens"].get<double>(),
        stated("stated_lumens",
               [&](double value) {
                   return fmt::format(" (file: {:.6g} lm, {:+.3g} %)", value,
                                      profile["difference_percent"].get<double>());
               }),
        100.0 * profile["down_share"].get<double>(),
        stated("stated_down_share",
               [](double value) { return fmt::format(" (file: {:.4g} %)", 100.0 * value); }),
        profile["lights"].get<int>());
}

// A feature's cost, a device, a clip or a photometric file in one line.
std::string object_line(const Json& entry) {
    if (entry.contains("lumens")) return profile_line(entry);
    if (entry.contains("length_s")) return clip_line(entry);
    std::string line = shown_value(entry["name"]);
    if (!entry.contains("ms")) return line;
    line += fmt::format(": {:+} bytes per pixel, ", entry["bytes_per_pixel"].get<int>());
    if (entry["ms"].is_null()) return line + shown_value(entry["why"]);
    const double ms = entry["ms"], noise_ms = entry["noise_ms"];
    if (!entry["measurable"].get<bool>())
        return line + fmt::format("no measurable cost (noise {:.3f} ms)", noise_ms);
    return line + fmt::format("{:+.3f} ms ({:+.1f} %, noise {:.3f} ms)", ms,
                              entry["percent"].get<double>(), noise_ms);
}

// "name: value" lines, objects indented below their name, lists of texts with a dash each.
void add_lines(std::string& out, const Json& value, const std::string& indent) {
    for (const auto& [name, part] : value.items()) {
        const bool texts = part.is_array() && !part.empty() && !part.front().is_number();
        if (!part.is_object() && !texts) {
            out += indent + name + ": " + shown_value(part) + "\n";
            continue;
        }
        out += indent + name + ":\n";
        if (part.is_object()) {
            add_lines(out, part, indent + "  ");
            continue;
        }
        for (const Json& entry : part) {
            out += indent + "  - " + (entry.is_object() ? object_line(entry) : shown_value(entry)) +
                   "\n";
        }
    }
}

// Measures the limits again and compares them with independent ones; stores those that agree.
void run_check(const InfoOptions& options) {
    const Gpu gpu(choose_device(options.shared.settings.device));
    const DeviceLimits limits = measure_device_limits(gpu);
    Table table{{"limit", "measured [1/s]", "independent [1/s]", "ratio", "result"}, {}};
    std::string failed;
    for (const LimitCheck& check : check_limits(gpu.info, limits)) {
        const bool agrees = check.agrees(kLimitFactor);
        if (!agrees) failed += " " + check.name;
        table.rows.push_back({check.name, check.measured, check.independent, check.ratio(),
                              std::string(agrees ? "agrees" : "differs")});
    }
    print_result(options.json, table_json(table), to_markdown(table));
    if (!failed.empty()) {
        throw ComparisonFailed(fmt::format(
            "limits differ from the independent ones by more than a factor of {}:{}; other work on "
            "the machine may be why",
            kLimitFactor, failed));
    }
    keep_device_limits(gpu.info, limits);
}

void run_info(InfoOptions& options) {
    begin_command(options.shared);
    if (options.check_limits) return run_check(options);
    const Json document = info_json(options);
    std::string text;
    add_lines(text, document, "");
    print_result(options.json, document, text);
}

constexpr const char* kInfoExamples =
    "  kilolux info\n"
    "  kilolux info town.glb --json\n"
    "  kilolux info atrium --costs\n"
    "  kilolux info --check-limits\n"
    "  kilolux info --list-devices\n"
    "  kilolux info --device 1 --gbuffer full";

}  // namespace

void visit_settings(InfoOptions& options, const SettingVisitor& f) {
    visit_settings(options.shared, f);
    OptionBuilder(f, "Output")
        .flag("--json", options.json, "JSON instead of text")
        .flag("--costs", options.costs,
              "Measure what each feature that the scene does without would cost on this picture")
        .flag("--measure-limits", options.measure_limits,
              "Measure the device's limits again, and keep them")
        .flag("--check-limits", options.check_limits,
              "Measure the device's limits again and compare them with C++ loops on a CPU or with "
              "published peaks of a GPU; exit 3 if they differ by more than a factor of 1.6");
}

void add_info_command(Program& program) {
    program.add_command("info",
                        "Tell the devices, what the scene holds, and what of the renderer it needs",
                        kInfoExamples, add_options<InfoOptions>, run_info);
}

}  // namespace kilolux
