// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/certify/synthetic/light_sets.h"
#include "host/certify/synthetic/stage_run.h"
#include "host/certify/synthetic/synthetic.h"

namespace kilolux {

/// An image, a grid and lights that try to slip through it.
struct CullScenario {
    std::string name;
    ViewShape shape;
    GridRequest request;
    DepthOf depth;
    uint layout = GBUFFER_PACKED;
    bool spots = false;
    uint light_count = 1200;
};

std::vector<CullScenario> cull_scenarios();

/// What a scenario is made into: `lights` as the host hands them over.
struct CullCase {
    KernelFeatures features;
    ClusterGrid grid{};
    GBuffer gbuffer;
    Planes planes;
    std::vector<uint> pixels;  // y * width + x of drawn pixels: all, or a sample
    std::vector<Light> lights;
};

/// A sixth of the lights each: anywhere; tangent to a pixel within 4 ulp; centred on the grid's
/// planes; up to 1e6 times the scene; down to 1e-6 of it and around a pixel; behind and around the
/// camera.
CullCase make_cull_case(const Gpu& gpu, const CullScenario& scenario);

}  // namespace kilolux
