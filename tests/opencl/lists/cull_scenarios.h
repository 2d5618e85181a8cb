// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/certify/synthetic/host_lists.h"
#include "host/certify/synthetic/synthetic.h"

namespace kilolux {

/// A view, a grid and the kind of lights to cull.
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

/// A scenario with its G-buffer and lights; `lights` are camera-relative.
struct CullCase {
    KernelFeatures features;
    ClusterGrid grid{};
    GBuffer gbuffer;
    Planes planes;
    std::vector<uint> pixels;  // y * width + x of surface pixels: all, or a sample
    std::vector<Light> lights;
};

/// Six kinds of lights in turn: anywhere; tangent to a pixel within 4 ulp; centred on the grid's
/// planes; up to 1e6 times the scene; down to 1e-6 of it around a pixel; around the camera.
CullCase make_cull_case(const Gpu& gpu, const CullScenario& scenario);

}  // namespace kilolux
