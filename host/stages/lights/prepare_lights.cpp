// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lights/prepare_lights.h"

namespace kilolux {
PrepareLights::PrepareLights(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      program_(build_program(gpu, kPrepareLightsStage)),
      prepare_(gpu, program_, kPrepareLightsStage, "prepare_lights"),
      prepare_directional_(gpu, program_, kPrepareLightsStage, "prepare_directional_lights"),
      lights_(gpu, kPrepareLightsStage),
      bounds_(gpu, kPrepareLightsStage),
      extents_(gpu, kPrepareLightsStage),
      directional_(gpu, kPrepareLightsStage),
      profiles_(gpu, kPrepareLightsStage) {}

ProfileInput PrepareLights::aim_profiles(const LightInput& input, const View& view,
                                         StageTimer& timer) {
    if (!input.profiles.lights) return {};
    if (!aim_profiles_) {
        BuildOptions options;
        options.define("HAS_LIGHT_PROFILES", 1);
        aim_profiles_.emplace(gpu_, build_program(gpu_, kPrepareLightsStage, options),
                              kPrepareLightsStage, "aim_profiles");
    }
    const uint rows = input.count + input.node_count;
    const DeviceArray<AimedProfile> out = profiles_.reserve(rows);
    if (rows > 0) {
        aim_profiles_->enqueue(items(rows, tuning_.light_group), timer, *input.profiles.lights,
                               rows, view, out);
    }
    return {out, input.profiles.tables};
}

PreparedLights PrepareLights::enqueue(const LightInput& input, const View& view,
                                      const ClusterGrid& grid, StageTimer& timer) {
    PreparedLights out;
    out.count = input.count;
    out.directional_count = input.directional_count;
    out.node_count = input.node_count;
    out.nodes = input.nodes;
    const uint rows = out.rows();
    out.lights = lights_.reserve(rows);
    out.bounds = bounds_.reserve(rows);
    out.extents = extents_.reserve(rows);
    out.directional = directional_.reserve(input.directional_count);
    if (rows > 0) {
        prepare_.enqueue(prepare_.vector_items(rows, tuning_.light_group), timer, input.lights,
                         input.seed, view, grid, out);
    }
    if (input.directional_count > 0) {
        prepare_directional_.enqueue(items(input.directional_count, 1), timer, input.directional,
                                     view, out.directional);
    }
    out.profiles = aim_profiles(input, view, timer);
    return out;
}

StageWork prepare_lights_work(const StageCounts& c) {
    const double directional = c.directional_lights * sizeof(DirectionalLight);
    constexpr double kPrepared = sizeof(ShadeLight) + kRowBytes + sizeof(LightExtent);
    return {.bytes_read = c.lights * sizeof(Light) + directional,
            .bytes_written = c.lights * kPrepared + directional,
            .launches = (c.lights > 0.0 ? 1 : 0) + (c.directional_lights > 0.0 ? 1 : 0)};
}

}  // namespace kilolux
