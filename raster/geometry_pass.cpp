// SPDX-License-Identifier: Apache-2.0
#include "raster/geometry_pass.h"

#include <algorithm>
#include <array>
#include <string>

#include "host/base/error.h"
#include "raster/gl_debug.h"
#include "raster/raster_state.h"

namespace kilolux {
namespace {

// Uniform location of geometry.frag.
constexpr GLint kEmissiveScaleInv = 7;

// Features that reach a plane of the layout.
uint feature_mask(const GBufferNeeds& needs) {
    uint mask = ~0u;
    if (!needs.material) mask = without_texture(mask, USE_EMISSIVE);
    if (!needs.occlusion) mask = without_texture(mask, USE_OCCLUSION);
    return mask;
}

}  // namespace

GeometryPass::GeometryPass(const GpuScene& scene, const GBufferNeeds& needs)
    : scene_(scene),
      needs_(needs),
      plan_(plan_targets(needs)),
      programs_(scene, "raster/shaders/geometry.frag", plan_.defines, feature_mask(needs)),
      draw_list_(scene.scene()) {
    programs_.for_each([&](GLuint program) {
        glProgramUniform1f(program, kEmissiveScaleInv, 1.0f / needs.emissive_scale);
    });
    check_gl_errors("geometry pass");
}

void GeometryPass::draw(const Camera& camera, int width, int height) {
    if (!targets_ || targets_->width() != width || targets_->height() != height) {
        check_target_size(width, height);
        targets_.reset();
        targets_ = std::make_unique<GBufferTargets>(plan_, width, height);
    }
    const std::vector<Draw> draws =
        draw_list_.visible(camera, width, height, false, DrawOrder::front_to_back);
    drawn_instances_ = draws.size();
    timer_.begin();
    {
        const RasterState state(targets_->framebuffer(), width, height);
        targets_->clear();
        programs_.draw(scene_, draws, glm::mat4(clip_from_view(camera, width, height)));
    }
    timer_.end();
    check_gl_errors("geometry pass");
}

void check_target_size(int width, int height) {
    std::array<GLint, 2> viewport{};
    GLint texture = 0;
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
    const int largest = std::min({viewport[0], viewport[1], texture});
    if (width >= 1 && height >= 1 && width <= largest && height <= largest) return;
    throw Error("resolution " + std::to_string(width) + "x" + std::to_string(height) +
                " pixels: this OpenGL draws 1 to " + std::to_string(largest) + " a side");
}

}  // namespace kilolux
