// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>

#include "host/scene/draw_list.h"
#include "raster/gpu_scene.h"

namespace kilolux {

/// How a pass draws a scene.
struct ScenePass {
    std::string fragment;  // file of the shader
    Defines defines{};     // of every variant, beside feature_defines()
    PassInputs inputs{};   // of that shader
    uint mask = ~0u;       // features that it looks at
    bool blended = false;  // the materials that blend, or those that do not
};

/// A pass that draws coverage alone.
ScenePass coverage_pass(const std::string& fragment, bool ids = false);

/// The variants of one fragment shader that a scene needs, by feature bits; all are compiled when
/// this is made.
class ScenePrograms {
 public:
    ScenePrograms(const GpuScene& scene, const ScenePass& pass);

    std::size_t size() const { return programs_.size(); }

    /// Draws in the given order with the current framebuffer and state.
    void draw(const GpuScene& scene, std::span<const Draw> draws, const glm::mat4& clip) const;

    /// Calls set(program name) for every variant, to set uniforms.
    template <typename Set>
    void for_each(Set set) const {
        for (const auto& entry : programs_) set(entry.second.name());
    }

 private:
    std::map<uint, GlProgram> programs_;
    uint mask_;
};

}  // namespace kilolux
