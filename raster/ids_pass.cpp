// SPDX-License-Identifier: Apache-2.0
#include "raster/ids_pass.h"

#include "raster/gl_debug.h"
#include "raster/raster_state.h"

namespace kilolux {

IdsPass::IdsPass(const GpuScene& scene)
    : scene_(scene),
      programs_(scene, coverage_pass("raster/shaders/ids.frag", true)),
      draw_list_(scene.scene()) {
    check_gl_errors("ids pass");
}

void IdsPass::draw(const Camera& camera, int width, int height, const OpenTiles* open) {
    if (!targets_ || targets_->width() != width || targets_->height() != height) {
        check_target_size(width, height);
        targets_.reset();
        targets_ = std::make_unique<GBufferTargets>(plan_id_targets(), width, height);
    }
    draws_ = draw_list_.visible(camera, width, height, false, DrawOrder::front_to_back, open);
    timer_.begin();
    {
        const RasterState state(targets_->framebuffer(), width, height);
        targets_->clear();
        programs_.draw(scene_, draws_, glm::mat4(clip_from_view(camera, width, height)));
    }
    timer_.end();
    check_gl_errors("ids pass");
}

}  // namespace kilolux
