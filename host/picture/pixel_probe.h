// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "host/picture/web_in_view.h"
#include "kernels/shared/area/area_shape.h"
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/clusters.h"
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/light.h"

namespace kilolux {

/// A light of a pixel's list.
struct ProbedLight {
    uint index = 0;              // among the point and spot lights in use
    Light light{};               // camera-relative, world axes
    ShadeLight shade{};          // as shading has it, view space
    WebInView web{};             // its photometric web, if it has one
    LightShape shape{};          // its shape, view space
    std::optional<bool> seen{};  // with shadows: whether nothing hides it from the pixel
};

/// SURFACE_*: view space; depth 0: background.
using SurfaceValues = std::array<float, SURFACE_PLANES>;

/// A surface that blends over those behind it.
struct ProbedLayer {
    SurfaceValues surface{};
    std::string material;  // its name
};

/// What is known of one pixel and of the lists that light it.
struct PixelProbe {
    SurfaceValues surface{};          // the opaque one
    std::vector<ProbedLayer> layers;  // blended ones in front of the opaque one, from near to far
    bool unlit = false;               // whether a roughness of 0 means an unlit surface
    ClusterGrid grid{};
    uint tile_x = 0, tile_y = 0, slice = 0;  // its coarse cluster
    uint coarse_count = 0;                   // lights in the coarse cluster's list
    std::optional<ActiveCluster> active;     // view space; none unless the renderer has them
    bool has_list = false;                   // else the renderer evaluates every light
    std::vector<ProbedLight> lights;         // in the list that is evaluated at the pixel
    bool has_surface() const { return surface[SURFACE_DEPTH] != 0.0f; }
};

}  // namespace kilolux
