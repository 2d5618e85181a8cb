// SPDX-License-Identifier: Apache-2.0
#include "raster/forward_pass.h"

#include <fmt/format.h>
#include <algorithm>
#include <initializer_list>
#include <utility>

#include "raster/gl_debug.h"
#include "raster/raster_state.h"

namespace kilolux {
namespace {

LightAccess light_access(const ForwardFeatures& features) {
    return features.light_access.value_or(faster_light_access());
}

ScenePass shaded_pass(ForwardFeatures features, bool blended) {
    features.transmission &= blended;
    const bool textures = light_access(features) == LightAccess::texture;
    ScenePass pass{.fragment = "raster/shaders/forward.frag",
                   .defines = feature_macros(features),
                   .blended = blended};
    pass.defines.emplace_back("SHADING", fmt::to_string(features.shading));
    pass.defines.emplace_back("LIGHT_TEXTURES", textures ? "1" : "0");
    pass.defines.emplace_back("CLUSTERED", features.clustered ? "1" : "0");
    pass.defines.emplace_back("BLENDED", blended ? "1" : "0");
    pass.uses = kept_uses(features);
    return pass;
}

TargetPlan radiance_plan() {
    TargetPlan plan;
    plan.color_formats = {GL_RGBA32F};
    for (const GLenum component : std::initializer_list<GLenum>{GL_RED, GL_GREEN, GL_BLUE}) {
        plan.reads.push_back({component - GL_RED, GL_COLOR_ATTACHMENT0, component, GL_FLOAT});
    }
    return plan;
}

// Planes to the target's texture, one pixel's components side by side.
void load_radiance(const GBufferTargets& targets, std::span<const float> planes) {
    const auto height = static_cast<std::size_t>(targets.height());
    const std::size_t plane = planes.size() / 3;
    std::vector<float> pixels(planes.size());
    for (std::size_t i = 0; i < plane; ++i) {
        for (std::size_t c = 0; c < 3; ++c) pixels[3 * i + c] = planes[c * plane + i];
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, static_cast<GLint>(plane / height));
    glTextureSubImage2D(targets.color_texture(0), 0, 0, 0, targets.width(), targets.height(),
                        GL_RGB, GL_FLOAT, pixels.data());
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

}  // namespace

ForwardPass::ForwardPass(const GpuScene& scene, const ForwardFeatures& features)
    : draw_list_(scene.scene()),
      opaque_(scene, shaded_pass(features, false)),
      blended_(scene, shaded_pass(features, true)),
      light_buffers_(light_access(features)) {
    if (features.clustered) depth_.emplace(scene, coverage_pass(Coverage::depth));
    check_gl_errors("forward pass");
}

void ForwardPass::prepare(int width, int height) {
    if (targets_ && targets_->width() == width && targets_->height() == height) return;
    check_target_size(width, height);
    targets_.reset();
    targets_ = std::make_unique<GBufferTargets>(radiance_plan(), width, height);
}

// A pass takes about as long as the one before it of the same work.
void ForwardPass::expect(const ForwardLights& lights) {
    constexpr double kQuick = 1e7;  // lights of pixels, which llvmpipe shades in 0.3 s
    const Work work{lights.lights.size() + lights.directional.size(), lights.light_lists.size(),
                    targets_->width(), targets_->height()};
    const bool is_known = std::exchange(is_whole_, false) && work == work_;
    cost_ = {.first_pixels = kQuick / static_cast<double>(std::max<std::size_t>(work.lights, 1))};
    if (is_known) cost_.expected_s = 1e-3 * timer_.last_ms();
    work_ = work;
}

void ForwardPass::draw(const Camera& camera, int width, int height, const ForwardLights& lights,
                       std::span<const float> background) {
    prepare(width, height);
    expect(lights);
    light_buffers_.upload(lights, view_of(camera, width, height));
    const CameraRow row = camera_row(camera, view_of(camera, width, height), width, height);
    {
        const GlTimer::Scope timed(timer_);
        const RasterState state(targets_->framebuffer(), width, height);
        light_buffers_.bind();
        targets_->clear();
        if (!background.empty()) load_radiance(*targets_, background);
        draw_opaque(camera, row);
        draw_transparent(camera, row);
    }
    is_whole_ = true;
    check_gl_errors("forward pass");
}

void ForwardPass::draw_opaque(const Camera& camera, const CameraRow& row) {
    const int width = targets_->width();
    const int height = targets_->height();
    const DrawOrder order = depth_ ? DrawOrder::front_to_back : DrawOrder::scene;
    const std::vector<Draw> draws = draw_list_.visible(camera, width, height, false, order);
    if (depth_) {
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        depth_->draw(draws, row);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glDepthMask(GL_FALSE);
        glDepthFunc(GL_EQUAL);
    }
    draw_in_parts(width, height, cost_, [&] { opaque_.draw(draws, row); });
}

void ForwardPass::draw_transparent(const Camera& camera, const CameraRow& row) {
    const int width = targets_->width();
    const int height = targets_->height();
    const std::vector<Draw> draws =
        draw_list_.visible(camera, width, height, true, DrawOrder::back_to_front);
    if (draws.empty()) return;
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_SRC1_COLOR);
    draw_in_parts(width, height, cost_, [&] { blended_.draw(draws, row); });
}

std::vector<float> ForwardPass::read_radiance(uint stride) const {
    const std::size_t plane = std::size_t{stride} * static_cast<std::size_t>(targets_->height());
    std::vector<float> radiance(3 * plane);
    for (const PlaneRead& read : targets_->reads()) {
        read_plane(*targets_, read, stride, radiance.data() + read.plane * plane);
    }
    check_gl_errors("reading the forward pass");
    return radiance;
}

}  // namespace kilolux
