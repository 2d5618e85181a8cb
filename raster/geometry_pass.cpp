// SPDX-License-Identifier: Apache-2.0
#include "raster/geometry_pass.h"

#include "raster/gl_debug.h"
#include "raster/raster_state.h"

namespace kilolux {
namespace {

// Uniform locations of geometry.frag.
constexpr GLint kEmissiveScaleInv = 7;
constexpr GLint kWorldFromView = 8;

// Features that reach a plane of the layout.
uint feature_mask(const GBufferNeeds& needs) {
    uint mask = ~0u;
    if (!needs.material) mask = without_texture(mask, USE_EMISSIVE);
    if (!needs.occlusion) mask = without_texture(mask, USE_OCCLUSION);
    if (!needs.specular) {
        mask = without_texture(without_texture(mask, USE_SPECULAR), USE_SPECULAR_COLOR);
    }
    return mask;
}

// For the layout that stores world positions.
void set_world_from_view(const ScenePrograms& programs, const Camera& camera) {
    const glm::mat4x3 world_from_view(
        glm::vec3(camera.world_from_view[0]), glm::vec3(camera.world_from_view[1]),
        glm::vec3(camera.world_from_view[2]), glm::vec3(camera.position));
    programs.for_each([&](GLuint program) {
        glProgramUniformMatrix4x3fv(program, kWorldFromView, 1, GL_FALSE, &world_from_view[0].x);
    });
}

}  // namespace

GeometryPass::GeometryPass(const GpuScene& scene, const GBufferNeeds& needs)
    : scene_(scene),
      needs_(needs),
      plan_(plan_targets(needs)),
      programs_(scene, {"raster/shaders/geometry.frag",
                        plan_.defines,
                        {.position = plan_.reads_position},
                        feature_mask(needs)}),
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
    if (needs_.layout == GBUFFER_HALF) set_world_from_view(programs_, camera);
    timer_.begin();
    {
        const RasterState state(targets_->framebuffer(), width, height);
        targets_->clear();
        programs_.draw(scene_, draws, glm::mat4(clip_from_view(camera, width, height)));
    }
    timer_.end();
    check_gl_errors("geometry pass");
}

}  // namespace kilolux
