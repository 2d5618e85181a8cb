// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lights/prepare_lights.h"

namespace kilolux {
PrepareLights::PrepareLights(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      program_(build_program(gpu, kPrepareLightsStage)),
      prepare_(gpu, program_, kPrepareLightsStage, "prepare_lights"),
      prepare_directional_(gpu, program_, kPrepareLightsStage, "prepare_directional_lights"),
      turn_rows_(gpu, program_, kPrepareLightsStage, "turn_rows"),
      lights_(gpu, kPrepareLightsStage),
      bounds_(gpu, kPrepareLightsStage),
      extents_(gpu, kPrepareLightsStage),
      directional_(gpu, kPrepareLightsStage),
      profiles_(gpu, kPrepareLightsStage),
      shapes_(gpu, kPrepareLightsStage) {}

LightExtraInput PrepareLights::turn_extras(const LightInput& input, const View& view,
                                           StageTimer& timer) {
    const std::size_t lights = std::size_t{input.count} + input.node_count;
    const auto turned = [&](const auto& rows, auto& out) {
        using Row = typename std::decay_t<decltype(rows)>::value_type;
        const DeviceArray<Row> result = out.reserve(lights);
        const std::size_t count = lights * (sizeof(Row) / sizeof(float4));
        if (count > 0) {
            turn_rows_.enqueue(items(count, tuning_.light_group), timer,
                               DeviceArray<float4>(rows.buffer(), count), static_cast<uint>(count),
                               view, DeviceArray<float4>(result.buffer(), count));
        }
        return result;
    };
    LightExtraInput out = input.extras;
    if (out.profiles) out.profiles = turned(*out.profiles, profiles_);
    if (out.shapes) out.shapes = turned(*out.shapes, shapes_);
    return out;
}

PreparedLights PrepareLights::enqueue(const LightInput& input, const View& view,
                                      const ClusterGrid& grid, StageTimer& timer) {
    PreparedLights out;
    out.count = input.count;
    out.directional_count = input.directional_count;
    out.node_count = input.node_count;
    out.nodes = input.nodes;
    out.index_before = input.index_before;
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
    out.extras = turn_extras(input, view, timer);
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
