// SPDX-License-Identifier: Apache-2.0
#include "host/certify/synthetic/light_sets.h"

#include <algorithm>
#include <cmath>

#include "host/certify/synthetic/probe.h"

namespace kilolux {
namespace {

float4 row(const glm::dvec3& v, double w) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
            static_cast<float>(w)};
}

}  // namespace

Light point_light(const glm::dvec3& position, double range, const glm::dvec3& intensity) {
    return {row(position, range), row(intensity, 1.0), {0.0f, 0.0f, 0.0f, -1.0f}};
}

Light spot_light(const Light& point, glm::dvec3 axis, double inner, double outer) {
    Light light = point;
    const double cos_out = std::cos(outer);
    light.color_scale.w = static_cast<float>(1.0 / std::max(0.001, std::cos(inner) - cos_out));
    light.axis_cos = row(axis, cos_out);
    return light;
}

std::vector<Light> random_lights(const View& view, const LightMix& mix) {
    Random random(mix.seed);
    std::vector<Light> lights;
    const bool orthographic = view.orthographic != 0;
    while (lights.size() < mix.count) {
        const double z = orthographic ? random.uniform(mix.z_near, mix.z_far)
                                      : random.log_uniform(mix.z_near, mix.z_far);
        const double px = view.width * (0.5 + random.uniform(-0.5, 0.5) * mix.spread);
        const double py = view.height * (0.5 + random.uniform(-0.5, 0.5) * mix.spread);
        const glm::dvec3 intensity{random.uniform(0, 10), random.uniform(0, 10),
                                   random.uniform(0, 10)};
        const double range = random.log_uniform(mix.range_min, mix.range_max);
        const glm::dvec3 p = world_from_view(view, position_at(view, px, py, z));
        const Light point = point_light(p, range, intensity);
        const double outer = random.uniform(0.05, 1.57);
        const bool spot = random.unit() < mix.spots;
        lights.push_back(spot ? spot_light(point, random.direction(), outer * random.unit(), outer)
                              : point);
    }
    return lights;
}

LightInput upload_lights(const Gpu& gpu, const std::vector<Light>& lights,
                         const std::vector<DirectionalLight>& directional) {
    return {new_buffer(gpu, lights), static_cast<uint>(lights.size()), new_buffer(gpu, directional),
            static_cast<uint>(directional.size())};
}

}  // namespace kilolux
