// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "host/measure/reference/light_contributions.h"
#include "host/scene/camera.h"
#include "raster/box_pass.h"

struct ImDrawList;

namespace kilolux {

/// A pixel that the mouse points at, and what its lists do there.
struct ProbedPixel {
    int x = 0, y = 0;           // of the picture [pixel]
    int width = 0, height = 0;  // of the picture [pixel]
    Camera camera;              // the picture's
    PixelProbe probe;
    std::vector<LightShare> shares;
};

/// The active clusters of a moment.
struct FrozenClusters {
    Camera camera;
    std::vector<ActiveCluster> clusters;  // in its view space
};

/// A picture's place in the window, window coordinates.
struct ScreenPlace {
    float x0 = 0.0f, y0 = 0.0f, x1 = 0.0f, y1 = 0.0f;
};

/// Edges of boxes from the corners of one camera's view space, as another sees them; clipped where
/// they are behind it. Pairs of window coordinates.
using ScreenLine = std::array<glm::vec2, 2>;
std::vector<ScreenLine> project_edges(const std::array<glm::dvec3, 8>& corners_world,
                                      const Camera& camera, const ScreenPlace& place);

/// Corners of the probed pixel's active and coarse cluster in the world; bit 0, 1, 2 of the place:
/// x, y, z.
std::array<glm::dvec3, 8> active_corners(const ProbedPixel& pixel);
std::array<glm::dvec3, 8> coarse_corners(const ProbedPixel& pixel);

/// Draws both over the picture, and its lights as dots, the brighter the larger.
void draw_probe(ImDrawList& draw, const ProbedPixel& pixel, const Camera& camera,
                const ScreenPlace& place);

/// The window of a probed pixel: tile, slice, box, and the list's lights. `corner`: its lower
/// right.
void describe_probe(const ProbedPixel& pixel, const std::array<float, 2>& corner, float scale);

/// Boxes for BoxPass, coloured by the lights in their lists. `least`: lights that a cluster must
/// have to be drawn.
std::vector<DrawnBox> boxes_of(const FrozenClusters& frozen, uint least);

}  // namespace kilolux
