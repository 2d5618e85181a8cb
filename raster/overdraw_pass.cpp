// SPDX-License-Identifier: Apache-2.0
#include "raster/overdraw_pass.h"

#include "raster/gbuffer_targets.h"
#include "raster/gl_debug.h"
#include "raster/raster_state.h"

namespace kilolux {
OverdrawPass::OverdrawPass(const GpuScene& scene)
    : scene_(scene),
      programs_(scene, coverage_pass("raster/shaders/overdraw.frag")),
      draw_list_(scene.scene()) {}

std::vector<float> OverdrawPass::count(const Camera& camera, int width, int height,
                                       DrawOrder order) const {
    check_target_size(width, height);
    const TargetPlan plan{{GL_R32F}, {}};
    const GBufferTargets targets(plan, width, height);
    const std::vector<Draw> draws = draw_list_.visible(camera, width, height, false, order);
    {
        const RasterState state(targets.framebuffer(), width, height);
        targets.clear();
        glEnable(GL_BLEND);
        glBlendEquation(GL_FUNC_ADD);
        glBlendFunc(GL_ONE, GL_ONE);
        programs_.draw(scene_, draws, glm::mat4(clip_from_view(camera, width, height)));
    }
    std::vector<float> counts(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    read_plane(targets, {0, GL_COLOR_ATTACHMENT0, GL_RED, GL_FLOAT}, static_cast<uint>(width),
               counts.data());
    check_gl_errors("overdraw pass");
    return counts;
}

}  // namespace kilolux
