// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "host/scene/camera.h"
#include "host/scene/draw_list.h"
#include "raster/gbuffer_targets.h"
#include "raster/gl_timer.h"
#include "raster/scene_programs.h"

namespace kilolux {

/// Draws which triangle each pixel shows, of a scene's opaque and masked surfaces: ids and depth,
/// no attribute. Materials that blend are left out.
class IdsPass {
 public:
    /// The GpuScene must outlive this. Throws Error when a shader does not compile.
    explicit IdsPass(const GpuScene& scene);

    /// Draws what the camera sees, sorted front to back. A pixel becomes 1 + first_triangle of its
    /// draw + its triangle's number in the mesh, or 0. Outside the tiles of `open` pixels may lack
    /// surfaces. Enqueues only; targets() holds the picture
    /// until the next call. Throws Error when the size is not positive or too large for the driver.
    void draw(const Camera& camera, int width, int height, const OpenTiles* open = nullptr);

    /// Where the latest draw() went. Another size makes new targets.
    const GBufferTargets& targets() const { return *targets_; }

    /// The instances of the latest draw(), in the order of their ids.
    std::span<const Draw> draws() const { return draws_; }

    /// GL time of the latest draw() [ms]; waits for it.
    double last_ms() const { return timer_.last_ms(); }

 private:
    const GpuScene& scene_;
    ScenePrograms programs_;
    DrawList draw_list_;
    std::unique_ptr<GBufferTargets> targets_;
    std::vector<Draw> draws_;
    GlTimer timer_;
};

}  // namespace kilolux
