// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>

#include "host/scene/draw_list.h"
#include "raster/gpu_scene.h"

namespace kilolux {

/// The variants of one fragment shader that a scene needs, by feature bits; all are compiled when
/// this is made.
class ScenePrograms {
 public:
    /// `common`: defines of every variant. `mask`: features that this pass looks at. `blended`: for
    /// the materials that blend, or for those that do not.
    ScenePrograms(const GpuScene& scene, const std::string& fragment, const Defines& common,
                  uint mask, bool blended = false);

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
