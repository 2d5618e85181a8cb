// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "present/commands/devices/device_helpers.h"

namespace kilolux {

/// A picture that several devices have made.
struct PictureByRows {
    Frame frame;  // with the counts of all devices, and the times of the slowest one
    std::vector<float> alpha;
    std::vector<DeviceShare> shares;
};

/// Whether several devices can make one picture: not where OpenGL lights surfaces, which takes
/// whole pictures.
bool has_rows_to_share(const RenderSettings& settings);

/// Makes the picture of SceneRenderer::render() with helpers, bit for bit; with `has_alpha` also
/// its coverage(). A free device takes the next rows. Throws as DeviceHelpers::run().
PictureByRows render_by_rows(DeviceHelpers& helpers, SceneRenderer& pictures, bool has_alpha,
                             double time, int frame);

}  // namespace kilolux
