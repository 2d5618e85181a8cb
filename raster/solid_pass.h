// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "host/base/formats/gbuffer_layout.h"
#include "host/scene/camera.h"
#include "host/scene/draw_list.h"
#include "raster/gbuffer_targets.h"
#include "raster/gl_timer.h"
#include "raster/scene_programs.h"

namespace kilolux {

/// Draws a scene's opaque and masked surfaces into targets; materials that blend are left out.
class SolidPass {
 public:
    /// Compiles the shader variants that the scene needs. `adds`: fragments that are kept add up.
    /// The GpuScene must outlive this. Throws Error with the driver's words when a shader does not
    /// compile.
    SolidPass(const GpuScene& scene, const ScenePass& pass, TargetPlan plan, bool adds = false);

    /// Draws what the camera sees. Background pixels are 0 in every plane. Outside the tiles of
    /// `open` pixels may lack surfaces. Enqueues only; targets() holds the picture until the next
    /// call. Throws Error when the size is not positive or too large for the driver.
    void draw(const Camera& camera, int width, int height, const OpenTiles* open = nullptr,
              DrawOrder order = DrawOrder::front_to_back);

    /// The targets of the latest draw(). Another size makes new targets.
    const GBufferTargets& targets() const { return *targets_; }

    /// The instances of the latest draw(), in its order.
    std::span<const Draw> draws() const { return draws_; }

    /// GL time of the latest draw() [ms]; waits for it.
    double last_ms() const { return timer_.last_ms(); }

    std::size_t variant_count() const { return programs_.size(); }

 private:
    ScenePrograms programs_;
    TargetPlan plan_;
    bool adds_;
    DrawList draw_list_;
    std::unique_ptr<GBufferTargets> targets_;
    std::vector<Draw> draws_;
    GlTimer timer_;
};

/// Which triangle each pixel shows: 1 + first_triangle of its draw + its number in the mesh, or 0.
class IdsPass : public SolidPass {
 public:
    static constexpr std::size_t kPixelBytes = 2 * sizeof(uint);  // of its targets: an id, a depth

    explicit IdsPass(const GpuScene& scene);
};

/// A G-buffer.
class GeometryPass : public SolidPass {
 public:
    GeometryPass(const GpuScene& scene, const GBufferNeeds& needs);
};

/// Counts the fragments that the G-buffer pass shades and keeps at each pixel: those that were
/// nearest when they were drawn and passed the alpha mask.
class OverdrawPass : public SolidPass {
 public:
    explicit OverdrawPass(const GpuScene& scene);

    /// Draws in the order given and returns the counts, width * height, row 0 on top.
    std::vector<float> count(const Camera& camera, int width, int height,
                             DrawOrder order = DrawOrder::front_to_back);
};

}  // namespace kilolux
