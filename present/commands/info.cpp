// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>

#include "host/base/log.h"
#include "host/base/suggest.h"
#include "host/measure/bench/known_costs.h"
#include "host/measure/roofline/device_limits.h"
#include "host/render/renderer.h"
#include "present/cli/device_list.h"
#include "present/cli/frame_summary.h"
#include "present/cli/option_builder.h"
#include "present/cli/options.h"
#include "present/cli/scene_choice.h"
#include "present/cli/stats_json.h"
#include "present/commands/bench.h"
#include "present/commands/commands.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
    SharedOptions shared;
    bool json = false;
    bool costs = false;
    std::string stats;
};

Json vector_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Json box_json(const Box& box) {
    if (box.empty()) return nullptr;
    return {{"min", vector_json(box.min)}, {"max", vector_json(box.max)}};
}

Json light_counts(const Scene& scene, const LightOptions& generated) {
    std::size_t counts[3] = {};
    for (const SceneLight& light : scene.lights) ++counts[static_cast<std::size_t>(light.type)];
    const LightScale scale = automatic_light_scale(generated, scene);
    return {{"point", counts[0]},
            {"spot", counts[1]},
            {"directional", counts[2]},
            {"generated", generated.count},
            {"generated_range_m", scale.radius},
            {"generated_intensity_cd", scale.intensity}};
}

Json scene_json(const Scene& scene, const LightOptions& generated) {
    return {
        {"name", scene.name},
        {"triangles", triangle_count(scene)},
        {"meshes", scene.meshes.size()},
        {"instances", scene.instances.size()},
        {"materials", scene.materials.size()},
        {"textures", scene.textures.size()},
        {"images", scene.images.size()},
        {"cameras", scene.cameras.size()},
        {"lights", light_counts(scene, generated)},
        {"bounds", box_json(bounds(scene))},
        {"light_box", box_json(scene.light_box.empty() ? resting_bounds(scene) : scene.light_box)}};
}

// Measures what each feature that the scene does without would cost on this picture, and keeps it.
void measure_costs(const InfoOptions& options, const Scene& scene, const DeviceInfo& device) {
    const RenderSettings& settings = options.shared.settings;
    const Camera camera = choose_camera(options.shared.camera, scene);
    LightingBench bench(scene, settings, camera, options.shared.time);
    keep_feature_costs(device, scene, settings, measure_feature_costs(bench));
}

Json info_json(const InfoOptions& options) {
    const Scene scene = open_scene(options.shared);
    const Renderer renderer(scene, options.shared.settings);
    const ScenePlan& plan = renderer.plan();
    Json out;
    out["device"] = device_json(renderer.device());
    out["devices"] = Json::array();
    for (const DeviceInfo& device : list_devices()) out["devices"].push_back(device_json(device));
    out["scene"] = scene_json(scene, options.shared.settings.lights);
    out["plan"] = plan.features;
    if (options.costs) measure_costs(options, scene, renderer.device());
    out["left_out"] = Json::array();
    for (const FeatureCost& cost :
         known_feature_costs(renderer.device(), scene, options.shared.settings)) {
        out["left_out"].push_back(cost_json(cost));
    }
    out["gbuffer_bytes_per_pixel"] = plan.gbuffer_bytes_per_pixel;
    out["limits"] =
        limits_json(cached_device_limits(Gpu(choose_device(options.shared.settings.device))));
    return out;
}

std::string text_of(const Json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
}

// A feature's cost or a device in one line.
std::string object_line(const Json& entry) {
    std::string line = text_of(entry["name"]);
    if (!entry.contains("ms")) return line;
    char text[128];
    std::snprintf(text, sizeof text, ": %+d bytes per pixel, ",
                  entry["bytes_per_pixel"].get<int>());
    line += text;
    if (entry["ms"].is_null()) return line + text_of(entry["why"]);
    std::snprintf(text, sizeof text, "%+.3f ms (%+.1f %%, noise %.3f ms)",
                  entry["ms"].get<double>(), entry["percent"].get<double>(),
                  entry["noise_ms"].get<double>());
    return line + text;
}

// "name: value" lines, objects indented below their name, lists of texts with a dash each.
void add_lines(std::string& out, const Json& value, const std::string& indent) {
    for (const auto& [name, part] : value.items()) {
        const bool texts = part.is_array() && !part.empty() && !part.front().is_number();
        if (!part.is_object() && !texts) {
            out += indent + name + ": " + text_of(part) + "\n";
            continue;
        }
        out += indent + name + ":\n";
        if (part.is_object()) {
            add_lines(out, part, indent + "  ");
            continue;
        }
        for (const Json& entry : part) {
            out +=
                indent + "  - " + (entry.is_object() ? object_line(entry) : text_of(entry)) + "\n";
        }
    }
}

void run_info(const InfoOptions& options) {
    set_verbosity(verbosity_of(options.shared));
    const Json document = info_json(options);
    if (!options.stats.empty()) write_json(options.stats, document);
    if (options.json) return write_json("-", document);
    if (options.stats == "-") return;
    std::string text;
    add_lines(text, document, "");
    std::fputs(text.c_str(), stdout);
}

constexpr const char* kExamples =
    "  kilolux info\n"
    "  kilolux info town.glb --json\n"
    "  kilolux info atrium --costs\n"
    "  kilolux info --list-devices\n"
    "  kilolux info --device 1 --gbuffer full";

}  // namespace

void add_info_command(Program& program) {
    const auto options = std::make_shared<InfoOptions>();
    CLI::App& command = program.add_command(
        "info", "Tell the devices, what the scene holds, and what of the renderer it needs",
        kExamples, [options] { run_info(*options); });
    add_shared_options(command, options->shared);
    OptionBuilder(command, "Output")
        .flag("--json", options->json, "JSON instead of text")
        .flag("--costs", options->costs,
              "Measure what each feature that the scene does without would cost on this picture, "
              "and keep it for the next time")
        .text({"--stats", "FILE", "", "Write the JSON to a file; - for standard output"},
              options->stats);
}

}  // namespace kilolux
