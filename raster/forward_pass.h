// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "host/base/scene_features.h"
#include "host/scene/camera.h"
#include "raster/forward_lights.h"
#include "raster/gbuffer_targets.h"
#include "raster/gl_timer.h"
#include "raster/parted_draw.h"
#include "raster/scene_programs.h"

namespace kilolux {

/// Features that forward shading compiles in; the others are left out.
struct ForwardFeatures : SceneFeatures {
    int shading = 0;         // SHADING_*, kernels/shared/evaluate_modes.h
    bool clustered = false;  // forward-plus: lights of the coarse cluster; else all of them
    std::optional<LightAccess> light_access;  // none: the faster one here
};

/// Shades a scene where it is drawn, in linear HDR. `forward`: objects in the scene's order, every
/// light for every fragment. `forward-plus` (clustered): depth first, then once a pixel with the
/// lights of its coarse cluster. Materials that blend come last, back to front.
class ForwardPass {
 public:
    static constexpr std::size_t kPixelBytes = 5 * sizeof(float);  // of its targets: RGBA, a depth

    /// Compiles the variants that the scene needs. The GpuScene must outlive this.
    ForwardPass(const GpuScene& scene, const ForwardFeatures& features);

    /// Draws the whole scene over `background` (float[3][height][stride]; empty: 0). Enqueues only.
    void draw(const Camera& camera, int width, int height, const ForwardLights& lights,
              std::span<const float> background = {});

    /// The picture as float[3][height][stride]; waits for it. 0 past the width.
    std::vector<float> read_radiance(uint stride) const;

    const GBufferTargets& targets() const { return *targets_; }

    /// GL time of the latest draw [ms]; waits for it.
    double last_ms() const { return timer_.last_ms(); }

 private:
    // What the seconds of a pass depend on.
    struct Work {
        std::size_t lights = 0, listed = 0;
        int width = 0, height = 0;
        bool operator==(const Work&) const = default;
    };

    void prepare(int width, int height);
    void expect(const ForwardLights& lights);
    void draw_opaque(const Camera& camera, const CameraRow& row);
    void draw_transparent(const Camera& camera, const CameraRow& row);

    DrawList draw_list_;
    std::optional<ScenePrograms> depth_;  // of forward-plus
    ScenePrograms opaque_, blended_;
    ForwardLightBuffers light_buffers_;
    std::unique_ptr<GBufferTargets> targets_;
    GlTimer timer_;
    Work work_;              // of the pass before
    bool is_whole_ = false;  // that pass was drawn to its end
    PassCost cost_;          // of this pass
};

}  // namespace kilolux
