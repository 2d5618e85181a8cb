// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>

#include "host/scene/camera.h"
#include "raster/gl_program.h"
#include "raster/gpu_scene.h"
#include "raster/shaders/draw_rows.h"

namespace kilolux {

/// How a pass draws a scene.
struct ScenePass {
    std::string fragment;   // file of the shader
    Defines defines{};      // of every variant, beside surface_macros()
    uint uses = ~0u;        // textures that it reads, bits 1 << USE_*
    bool coverage = false;  // only coverage is drawn
    bool blended = false;   // the materials that blend, or those that do not
};

/// The output of a pass that only draws coverage; depth in any case.
enum class Coverage { depth, ids, count };
ScenePass coverage_pass(Coverage writes);

/// The camera's row of a pass: `view` is the picture's, perhaps with rows of a band, and `camera`
/// sees the contents of the target.
CameraRow camera_row(const Camera& camera, const View& view, int width, int height);

/// The variants of one fragment shader that a scene's meshes need; the constructor compiles them.
class ScenePrograms {
 public:
    /// The GpuScene must outlive this.
    ScenePrograms(const GpuScene& scene, const ScenePass& pass);

    std::size_t size() const { return programs_.size(); }

    /// Draws the instances in the given order with the current framebuffer and state.
    void draw(std::span<const Draw> draws, const CameraRow& camera) const;

 private:
    const GpuScene& scene_;
    std::map<SurfaceFeatures, GlProgram> programs_;
    std::vector<SurfaceFeatures> features_;  // by mesh
    GlBuffer camera_;
};

}  // namespace kilolux
