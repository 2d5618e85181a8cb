// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/certify/synthetic/random.h"
#include "host/certify/synthetic/synthetic.h"
#include "host/gpu/flow.h"

namespace kilolux {

/// A point light of `range` [m] at a camera-relative world position.
Light point_light(const glm::dvec3& position, double range,
                  const glm::dvec3& intensity = {1, 1, 1});

/// A spot light towards unit `axis` with half angles [rad].
Light spot_light(const Light& point, glm::dvec3 axis, double inner, double outer);

/// How random_lights() draws.
struct LightMix {
    std::uint32_t count = 100;
    double z_near = 0.2;  // depths of the lights, log-uniform [m]
    double z_far = 60.0;
    double range_min = 0.05;  // log-uniform [m]
    double range_max = 5.0;
    double spots = 0.0;   // share of spot lights
    double spread = 1.3;  // 1: as wide as the image
    std::uint32_t seed = 7;
};

/// Lights in and around the frustum of a perspective view (or the box of an orthographic one).
std::vector<Light> random_lights(const View& view, const LightMix& mix);

LightInput upload_lights(const Gpu& gpu, const std::vector<Light>& lights,
                         const std::vector<DirectionalLight>& directional = {});

}  // namespace kilolux
