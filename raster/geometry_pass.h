// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "host/base/gbuffer_layout.h"
#include "host/scene/camera.h"
#include "raster/gbuffer_targets.h"
#include "raster/gl_timer.h"
#include "raster/scene_programs.h"

namespace kilolux {

/// Draws a scene's opaque and masked surfaces into a G-buffer; materials that blend are left out.
class GeometryPass {
 public:
    /// Compiles the shader variants that the scene needs. The GpuScene must outlive this.
    /// Throws Error with the driver's words when a shader does not compile.
    GeometryPass(const GpuScene& scene, const GBufferNeeds& needs);

    /// Draws what the camera sees, sorted front to back. Background pixels are 0 in every plane.
    /// Enqueues only; targets() then holds the picture until the next call.
    /// Throws Error when the size is not positive or too large for the driver.
    void draw(const Camera& camera, int width, int height);

    /// Where the latest draw() went. Another size makes new targets.
    const GBufferTargets& targets() const { return *targets_; }
    const GBufferNeeds& needs() const { return needs_; }

    /// GL time of the latest draw() [ms]; waits for it.
    double last_ms() const { return timer_.last_ms(); }

    std::size_t variant_count() const { return programs_.size(); }
    std::size_t drawn_instances() const { return drawn_instances_; }

 private:
    const GpuScene& scene_;
    GBufferNeeds needs_;
    TargetPlan plan_;
    ScenePrograms programs_;
    DrawList draw_list_;
    std::unique_ptr<GBufferTargets> targets_;
    GlTimer timer_;
    std::size_t drawn_instances_ = 0;
};

}  // namespace kilolux
