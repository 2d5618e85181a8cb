// SPDX-License-Identifier: Apache-2.0
#include "raster/solid_pass.h"

#include <fmt/format.h>

#include <utility>

#include "raster/gl_debug.h"
#include "raster/raster_state.h"

namespace kilolux {
namespace {

ScenePass planes_pass(const GBufferNeeds& needs) {
    ScenePass pass{.fragment = "raster/shaders/planes.frag", .defines = feature_macros(needs)};
    pass.defines.emplace_back("GBUFFER", fmt::to_string(needs.layout));
    const TargetPlan plan = plan_targets(needs);
    pass.defines.insert(pass.defines.end(), plan.defines.begin(), plan.defines.end());
    pass.defines.emplace_back("EMISSIVE_SCALE", fmt::format("{:.9e}", needs.emissive_scale));
    pass.uses = kept_uses(needs);
    return pass;
}

}  // namespace

SolidPass::SolidPass(const GpuScene& scene, const ScenePass& pass, TargetPlan plan, bool adds)
    : programs_(scene, pass), plan_(std::move(plan)), adds_(adds), draw_list_(scene.scene()) {
    check_gl_errors(pass.fragment);
}

void SolidPass::draw(const Camera& camera, int width, int height, const OpenTiles* open,
                     DrawOrder order) {
    if (!targets_ || targets_->width() != width || targets_->height() != height) {
        check_target_size(width, height);
        targets_.reset();
        targets_ = std::make_unique<GBufferTargets>(plan_, width, height);
    }
    draws_ = draw_list_.visible(camera, width, height, false, order, open);
    timer_.begin();
    {
        const RasterState state(targets_->framebuffer(), width, height);
        targets_->clear();
        if (adds_) {
            glEnable(GL_BLEND);
            glBlendEquation(GL_FUNC_ADD);
            glBlendFunc(GL_ONE, GL_ONE);
        }
        programs_.draw(draws_, camera_row(camera, view_of(camera, width, height), width, height));
    }
    timer_.end();
    check_gl_errors("drawing surfaces");
}

IdsPass::IdsPass(const GpuScene& scene)
    : SolidPass(scene, coverage_pass(Coverage::ids),
                {{GL_R32UI}, {{0, GL_COLOR_ATTACHMENT0, GL_RED_INTEGER, GL_UNSIGNED_INT}}}) {}

GeometryPass::GeometryPass(const GpuScene& scene, const GBufferNeeds& needs)
    : SolidPass(scene, planes_pass(needs), plan_targets(needs)) {}

OverdrawPass::OverdrawPass(const GpuScene& scene)
    : SolidPass(scene, coverage_pass(Coverage::count),
                {{GL_R32F}, {{0, GL_COLOR_ATTACHMENT0, GL_RED, GL_FLOAT}}}, true) {}

std::vector<float> OverdrawPass::count(const Camera& camera, int width, int height,
                                       DrawOrder order) {
    draw(camera, width, height, nullptr, order);
    std::vector<float> counts(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    read_plane(targets(), targets().reads().front(), static_cast<uint>(width), counts.data());
    return counts;
}

}  // namespace kilolux
