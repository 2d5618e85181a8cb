// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "host/base/version.h"
#include "present/cli/device_list.h"
#include "present/cli/names.h"
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
    return {
        {"light_seed", s.lights.seed},
        {"light_radius_m", s.lights.radius},
        {"light_intensity_cd", s.lights.intensity},
        {"light_box", s.lights.box.empty()
                          ? Json(nullptr)
                          : Json{s.lights.box.min.x, s.lights.box.min.y, s.lights.box.min.z,
                                 s.lights.box.max.x, s.lights.box.max.y, s.lights.box.max.z}},
        {"shading", name_of(s.shading)},
        {"ambient", s.ambient},
        {"math", math_names().at(static_cast<std::size_t>(s.kernels.math))},
        {"light_colors", light_color_names().at(static_cast<std::size_t>(s.kernels.light_colors))},
        {"range_budget", s.range_budget},
        {"samples", s.samples},
        {"bloom", s.bloom},
        {"tonemap", name_of(s.tone_curve)},
        {"time_s", shared.time}};
}

}  // namespace

Json program_json() { return {{"version", version()}, {"commit", KILOLUX_COMMIT}}; }

Json bench_context(const SharedOptions& shared, const BenchFrames& frames, const Scene& scene,
                   const Camera& camera, const DeviceInfo& device) {
    return {{"program", program_json()},
            {"device", device_json(device)},
            {"scene",
             {{"name", shared.scene},
              {"triangles", triangle_count(scene)},
              {"lights", scene.lights.size()}}},
            {"camera", camera_json(camera)},
            {"settings", settings_json(shared)},
            {"frames", {{"warm_up", frames.warm_up}, {"measured", frames.measured}}}};
}

std::string context_key(const Json& context) {
    // FNV-1a, 64 bits.
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : context.dump()) {
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    }
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

Json limits_json(const DeviceLimits& l) {
    return {{"lanes", l.lanes},
            {"fma_flops", l.fma_flops},
            {"one_lane_fma_flops", l.one_lane_fma_flops},
            {"effective_lanes", l.effective_lanes()},
            {"lane_instructions_per_s", l.lane_instructions_per_s},
            {"rsqrt_per_s", l.rsqrt_per_s},
            {"sqrt_per_s", l.sqrt_per_s},
            {"divisions_per_s", l.divisions_per_s},
            {"read_bytes_per_s", l.read_bandwidth},
            {"write_bytes_per_s", l.write_bandwidth},
            {"copy_bytes_per_s", l.copy_bandwidth},
            {"cached_read_bytes_per_s", l.cached_read_bandwidth},
            {"cached_write_bytes_per_s", l.cached_write_bandwidth},
            {"cached_copy_bytes_per_s", l.cached_copy_bandwidth},
            {"cache_bytes", l.cache_bytes},
            {"upload_bytes_per_s", l.upload_bandwidth},
            {"download_bytes_per_s", l.download_bandwidth},
            {"launch_latency_ms", l.launch_latency_ms},
            {"launch_event_ms", l.launch_event_ms}};
}

}  // namespace kilolux
