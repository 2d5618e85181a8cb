// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/measure/reference/light_contributions.h"
#include "host/scene/camera.h"
#include "present/window/overlay/projected_picture.h"
#include "raster/box_pass.h"

struct ImDrawList;

namespace kilolux {

/// The pixel under the mouse, and the lights of its list.
struct ProbedPixel {
    int x = 0, y = 0;           // of the picture [pixel]
    int width = 0, height = 0;  // of the picture [pixel]
    Camera camera;              // the picture's
    PixelProbe probe;
    std::vector<LightContribution> shares;
};

/// The active clusters of one picture.
struct FrozenClusters {
    Camera camera;
    std::vector<ActiveCluster> clusters;  // in its view space
};

/// Draws the pixel's active and coarse cluster over the picture of `camera`, and its lights as
/// circles, larger where they add more.
void draw_probe(ImDrawList& draw, const ProbedPixel& pixel, const Camera& camera,
                const ScreenPlace& place);

/// "59,126  depth 2.50 m", or that the pixel is background.
std::string pixel_line(const ProbedPixel& pixel);

/// Describes a box of text about the pixel in the lower right of the picture: tile, slice, size,
/// and as many of the list's lights as fit.
void describe_probe(const ProbedPixel& pixel, const ScreenPlace& place, float scale);

/// Lights of the longest list, at least 1.
uint longest_list(const FrozenClusters& frozen);

/// Describes the legend of the boxes' colours, in the lower left of the picture.
void describe_box_colors(uint most, const ScreenPlace& place, float scale);

/// Boxes for BoxPass, coloured by the length of their lists. Clusters of fewer than `least` lights
/// are left out.
std::vector<DrawnBox> boxes_of(const FrozenClusters& frozen, uint least);

}  // namespace kilolux
