// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <fstream>

#include "host/base/error.h"
#include "host/base/version.h"
#include "host/render/plan/kernel_choice.h"
#include "present/cli/commit.h"
#include "present/cli/names.h"
#include "present/cli/stats_json.h"
#include "present/commands/bench.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

Json camera_json(const Camera& camera) {
    const auto vector = [](const glm::dvec3& v) { return Json{v.x, v.y, v.z}; };
    Json out = {{"position", vector(camera.position)},
                {"backward", vector(camera.world_from_view[2])},
                {"up", vector(camera.world_from_view[1])},
                {"orthographic", camera.orthographic}};
    out[camera.orthographic ? "half_height_m" : "y_fov_rad"] =
        camera.orthographic ? camera.y_extent : camera.y_fov;
    return out;
}

Json settings_json(const SharedOptions& shared) {
    const RenderSettings& s = shared.settings;
    return {{"light_seed", s.lights.seed},
            {"light_radius_m", s.lights.radius},
            {"light_intensity_cd", s.lights.intensity},
            {"light_box", s.lights.box.empty()
                              ? Json(nullptr)
                              : Json{s.lights.box.min.x, s.lights.box.min.y, s.lights.box.min.z,
                                     s.lights.box.max.x, s.lights.box.max.y, s.lights.box.max.z}},
            {"geometry", name_of(s.geometry)},
            {"anisotropy", s.anisotropy},
            {"reuse", !s.no_reuse},
            {"shading", name_of(s.shading)},
            {"shadows", name_of(s.shadows)},
            {"ambient", s.ambient},
            {"math", name_of(s.kernels.math)},
            {"light_colors", name_of(s.kernels.light_colors)},
            {"tails", name_of(s.tails)},
            {"range_budget", s.range_budget},
            {"tail_seed", s.tail_seed},
            {"tree_share", s.tree_share},
            {"samples", s.samples},
            {"bloom", s.bloom},
            {"tonemap", name_of(s.tone_curve)},
            {"time_s", shared.time}};
}

}  // namespace

std::string command_line() {
    std::ifstream in("/proc/self/cmdline", std::ios::binary);
    std::string out = "kilolux", word;
    std::getline(in, word, '\0');  // the program's path
    while (std::getline(in, word, '\0')) {
        const bool plain = !word.empty() && word.find_first_of(" ;*'\"$") == std::string::npos;
        out += plain ? " " + word : " '" + word + "'";
    }
    return out;
}

Json program_json() { return {{"version", version()}, {"commit", commit()}}; }

Json tuning_json(const StoredTuning& stored) {
    Json out = {{"lanes", stored.lanes}};
    for (const TuningParameter& parameter : tuning_parameters())
        out[parameter.name] = stored.tuning.*parameter.value;
    return out;
}

Json bench_context(const SharedOptions& shared, const BenchFrames& frames, const Scene& scene,
                   const Camera& camera, const DeviceInfo& device) {
    return {{"program", program_json()},
            {"device", device_json(device)},
            {"tuning", tuning_json(choose_tuning(device, shared.settings.kernels))},
            {"scene",
             {{"name", shared.scene},
              {"triangles", triangle_count(scene)},
              {"lights", scene.lights.size()}}},
            {"camera", camera_json(camera)},
            {"settings", settings_json(shared)},
            {"frames", {{"warm_up", frames.warm_up}, {"measured", frames.measured}}}};
}

std::string context_difference(const Json& was, const Json& is) {
    const Json before = was.flatten(), now = is.flatten();
    for (const auto& [path, value] : now.items()) {
        if (before.contains(path) && before[path] == value) continue;
        return fmt::format("{} was {}, is {}", path.substr(1),
                           before.contains(path) ? before[path].dump() : "missing", value.dump());
    }
    return "";
}

void require_same_context(const std::filesystem::path& file, const Json& context) {
    std::ifstream in(file);
    const Json found = Json::parse(in, nullptr, false);
    if (!in || !found.contains("context"))
        throw Error(fmt::format("{}: missing or damaged; --resume needs it", file.string()));
    const std::string difference = context_difference(found["context"], context);
    if (!difference.empty()) {
        throw Error(
            fmt::format("{}: measured under other conditions: {}; choose another folder "
                        "or leave --resume out",
                        file.string(), difference));
    }
}

Json limits_json(const DeviceLimits& limits) {
    Json out = {{"lanes", limits.lanes}, {"effective_lanes", limits.effective_lanes()}};
    for (const LimitField& field : limit_fields()) out[field.name] = limits.*field.value;
    return out;
}

}  // namespace kilolux
