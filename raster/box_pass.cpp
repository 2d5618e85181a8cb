// SPDX-License-Identifier: Apache-2.0
#include "raster/box_pass.h"

#include <array>
#include <cstddef>
#include <glm/gtc/type_ptr.hpp>

#include "raster/gbuffer_targets.h"
#include "raster/gl_debug.h"
#include "raster/gl_program.h"

namespace kilolux {
namespace {

constexpr GLsizei kEdgeVertices = 24;  // two an edge
constexpr GLuint kAttributes = 3;

}  // namespace

BoxPass::BoxPass()
    : program_(load_program("raster/shaders/boxes.vert", "raster/shaders/boxes.frag", {})),
      vertex_array_(make_vertex_array()),
      boxes_(make_buffer()) {
    const GLuint array = vertex_array_.name();
    constexpr std::array<GLint, kAttributes> kSizes = {3, 3, 4};
    constexpr std::array<std::size_t, kAttributes> kOffsets = {
        offsetof(DrawnBox, min), offsetof(DrawnBox, max), offsetof(DrawnBox, color)};
    glVertexArrayVertexBuffer(array, 0, boxes_.name(), 0, sizeof(DrawnBox));
    glVertexArrayBindingDivisor(array, 0, 1);
    for (GLuint i = 0; i < kAttributes; ++i) {
        glEnableVertexArrayAttrib(array, i);
        glVertexArrayAttribFormat(array, i, kSizes[i], GL_FLOAT, GL_FALSE,
                                  static_cast<GLuint>(kOffsets[i]));
        glVertexArrayAttribBinding(array, i, 0);
    }
    set_depths({}, 0, 0);
    check_gl_errors("boxes");
}

void BoxPass::set_boxes(std::span<const DrawnBox> boxes, const Camera& from) {
    count_ = boxes.size();
    from_ = from;
    if (count_ == 0) return;
    glNamedBufferData(boxes_.name(), static_cast<GLsizeiptr>(boxes.size_bytes()), boxes.data(),
                      GL_STATIC_DRAW);
}

void BoxPass::set_depths(std::span<const float> depths, int width, int height) {
    constexpr float kNothing = 0.0f;
    const bool empty = depths.empty();
    depths_ = make_target(GL_R32F, empty ? 1 : width, empty ? 1 : height);
    glTextureSubImage2D(depths_.name(), 0, 0, 0, empty ? 1 : width, empty ? 1 : height, GL_RED,
                        GL_FLOAT, empty ? &kNothing : depths.data());
}

void BoxPass::draw(const Camera& camera, const BoxTarget& target) const {
    if (count_ == 0 || target.width <= 0 || target.height <= 0) return;
    glViewport(target.x, target.y, target.width, target.height);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glUseProgram(program_.name());
    // In double, like all transforms that involve a camera.
    const glm::dmat4 view = glm::inverse(world_from_camera(camera)) * world_from_camera(from_);
    const glm::mat4 clip(clip_from_view(camera, target.width, target.height));
    const glm::mat4 view_from_box(view);
    glUniformMatrix4fv(0, 1, GL_FALSE, glm::value_ptr(view_from_box));
    glUniformMatrix4fv(1, 1, GL_FALSE, glm::value_ptr(clip));
    glUniform4f(2, static_cast<float>(target.x), static_cast<float>(target.y),
                static_cast<float>(target.width), static_cast<float>(target.height));
    glBindTextureUnit(0, depths_.name());
    glBindSampler(0, 0);
    glBindVertexArray(vertex_array_.name());
    glDrawArraysInstanced(GL_LINES, 0, kEdgeVertices, static_cast<GLsizei>(count_));
    glBindVertexArray(0);
    glUseProgram(0);
}

}  // namespace kilolux
