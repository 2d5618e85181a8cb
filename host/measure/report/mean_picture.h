// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "host/render/renderer.h"
#include "host/scene/camera.h"

namespace kilolux {

/// The mean of pictures with sampled shadows that differ in their seed: what their noise is about,
/// since each is right in the mean.
struct MeanPicture {
    std::vector<double> rgb;       // [3 * pixels], linear
    std::vector<double> variance;  // [pixels], of the mean's luminance, by --aov error-standard
};

/// The extent of a mean.
struct MeanPlan {
    int rays = 64;  // a pixel of each picture
    int pictures = 32;
};

/// One sample a pixel, by `settings` otherwise, of seeds that no other picture of a measurement
/// has. `on_step` is called before every picture and may throw to stop.
MeanPicture mean_picture(const std::shared_ptr<RenderScene>& scene, const Camera& camera,
                         double time, RenderSettings settings, const MeanPlan& plan,
                         const std::function<void()>& on_step);

}  // namespace kilolux
