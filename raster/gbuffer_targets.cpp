// SPDX-License-Identifier: Apache-2.0
#include "raster/gbuffer_targets.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "host/base/error.h"
#include "raster/gl_context.h"
#include "raster/gl_debug.h"

namespace kilolux {
namespace {

constexpr std::size_t kMostTargets = 8;  // that every OpenGL draws to at once

// OpenGL's formats for a plane's elements: codes of any meaning.
struct ElementFormat {
    GLenum one, four;  // component formats of a target
    GLenum type;
};

ElementFormat element_format(uint bytes) {
    if (bytes == 1) return {GL_R8UI, GL_RGBA8UI, GL_UNSIGNED_BYTE};
    if (bytes == 2) return {GL_R16UI, GL_RGBA16UI, GL_UNSIGNED_SHORT};
    return {GL_R32UI, GL_RGBA32UI, GL_UNSIGNED_INT};
}

}  // namespace

GlTexture make_target(GLenum format, int width, int height) {
    GlTexture texture = make_texture(GL_TEXTURE_2D);
    glTextureStorage2D(texture.name(), 1, format, width, height);
    glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

// Each plane has a target of its own; where there are more than eight, up to three of one size
// share one. Reading a target's fourth component alone is not in OpenGL's core profile.
TargetPlan plan_targets(const GBufferNeeds& needs) {
    constexpr std::array<GLenum, 3> kComponents = {GL_RED_INTEGER, GL_GREEN_INTEGER,
                                                   GL_BLUE_INTEGER};
    const GBufferLayout layout = make_gbuffer_layout(needs, 16, 1);
    const auto planes = static_cast<std::size_t>(
        std::ranges::count_if(layout.offset_bytes, [](uint o) { return o != PLANE_ABSENT; }));
    const uint room = planes > kMostTargets ? 3 : 1;
    TargetPlan plan;
    std::string slots;
    uint component = 0;
    uint last_bytes = 0;
    for (uint plane = 0; plane < PLANE_COUNT; ++plane) {
        uint slot = 0;
        if (layout.offset_bytes[plane] != PLANE_ABSENT) {
            const uint bytes = plane_element_bytes(needs.layout, plane);
            const ElementFormat format = element_format(bytes);
            const bool whole = bytes > sizeof(uint);
            if (whole || bytes != last_bytes || ++component == room) {
                plan.color_formats.push_back(whole || room > 1 ? format.four : format.one);
                plan.pixel_bytes += whole || room == 1 ? bytes : 4 * bytes;
                component = 0;
                last_bytes = bytes;
            }
            const auto target = static_cast<uint>(plan.color_formats.size()) - 1;
            plan.reads.push_back({plane, GL_COLOR_ATTACHMENT0 + target,
                                  whole ? GL_RGBA_INTEGER : kComponents[component], format.type});
            slot = 4 * target + component;
        }
        slots += fmt::format("{}{}u", plane == 0 ? "" : ", ", slot);
    }
    if (plan.color_formats.size() > kMostTargets) {
        throw UsageError(fmt::format(
            "--geometry planes: {} planes of --gbuffer {} for this scene, OpenGL draws to {} at "
            "once; take --geometry ids",
            planes, gbuffer_layout_name(needs.layout), kMostTargets * room));
    }
    plan.defines = {{"ATTACHMENTS", fmt::to_string(plan.color_formats.size())},
                    {"PLANE_SLOTS", fmt::format("uint[PLANE_COUNT]({})", slots)}};
    return plan;
}

GBufferTargets::GBufferTargets(const TargetPlan& plan, int width, int height)
    : reads_(plan.reads),
      formats_(plan.color_formats),
      depth_(make_target(GL_DEPTH_COMPONENT32F, width, height)),
      framebuffer_(make_framebuffer()),
      width_(width),
      height_(height) {
    const GLuint target = framebuffer_.name();
    std::vector<GLenum> draw_buffers;
    for (const GLenum format : plan.color_formats) {
        const GLenum attachment = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(colors_.size());
        colors_.push_back(make_target(format, width, height));
        glNamedFramebufferTexture(target, attachment, colors_.back().name(), 0);
        draw_buffers.push_back(attachment);
    }
    glNamedFramebufferTexture(target, GL_DEPTH_ATTACHMENT, depth_.name(), 0);
    glNamedFramebufferDrawBuffers(target, static_cast<GLsizei>(draw_buffers.size()),
                                  draw_buffers.data());
    const GLenum status = glCheckNamedFramebufferStatus(target, GL_FRAMEBUFFER);
    const std::string what = fmt::format("G-buffer of {}x{} pixels", width, height);
    check_gl_errors(what);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        throw Error(fmt::format("{}: framebuffer status is {}", what, status));
    }
}

void GBufferTargets::clear() const {
    constexpr std::array<GLfloat, 4> kZero = {};
    constexpr std::array<GLuint, 4> kNone = {};
    for (std::size_t i = 0; i < colors_.size(); ++i) {
        const auto drawbuffer = static_cast<GLint>(i);
        if (formats_[i] != GL_RGBA32F && formats_[i] != GL_R32F) {
            glClearNamedFramebufferuiv(framebuffer_.name(), GL_COLOR, drawbuffer, kNone.data());
        } else {
            glClearNamedFramebufferfv(framebuffer_.name(), GL_COLOR, drawbuffer, kZero.data());
        }
    }
    glClearNamedFramebufferfv(framebuffer_.name(), GL_DEPTH, 0, kZero.data());
}

int largest_target() {
    std::array<GLint, 2> viewport{};
    GLint texture = 0;
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
    return std::min({viewport[0], viewport[1], texture});
}

void check_target_size(int width, int height) {
    const int largest = largest_target();
    if (width >= 1 && height >= 1 && width <= largest && height <= largest) return;
    throw Error(
        fmt::format("resolution {}x{} pixels: this OpenGL draws 1 to {} a side; OpenCL draws more "
                    "(--renderer deferred --geometry compute)",
                    width, height, largest));
}

namespace {

// llvmpipe reads pixels fast, but converts texels that it reads from textures.
void read_from_framebuffer(const GBufferTargets& targets, const PlaneRead& read, RowRange rows,
                           void* destination) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, targets.framebuffer());
    if (read.source != GL_DEPTH_ATTACHMENT) glReadBuffer(read.source);
    glReadPixels(0, rows.first, targets.width(), rows.count, read.format, read.type, destination);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
}

// NVIDIA's driver takes 0.2 ms for a plane of 1920x1080 this way, and 340 ms by glReadPixels.
void read_from_texture(const GBufferTargets& targets, const PlaneRead& read, RowRange rows,
                       void* destination) {
    const GLuint texture = read.source == GL_DEPTH_ATTACHMENT
                               ? targets.depth_texture()
                               : targets.color_texture(read.source - GL_COLOR_ATTACHMENT0);
    constexpr GLsizei kAnySize = std::numeric_limits<GLsizei>::max();
    if (rows.count == targets.height()) {
        glGetTextureImage(texture, 0, read.format, read.type, kAnySize, destination);
    } else {
        glGetTextureSubImage(texture, 0, 0, rows.first, 0, targets.width(), rows.count, 1,
                             read.format, read.type, kAnySize, destination);
    }
}

}  // namespace

void read_plane(const GBufferTargets& targets, const PlaneRead& read, uint stride,
                void* destination, RowRange rows) {
    if (rows.count == 0) rows.count = targets.height();
    glPixelStorei(GL_PACK_ALIGNMENT, stride % 4 == 0 ? 4 : 1);
    const bool padded = stride != static_cast<uint>(targets.width());
    if (padded) glPixelStorei(GL_PACK_ROW_LENGTH, static_cast<GLint>(stride));
    if (is_software_renderer()) {
        read_from_framebuffer(targets, read, rows, destination);
    } else {
        read_from_texture(targets, read, rows, destination);
    }
    glPixelStorei(GL_PACK_ROW_LENGTH, 0);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
}

std::vector<std::byte> read_gbuffer(const GBufferTargets& targets, const GBufferLayout& layout,
                                    uint stride) {
    std::vector<std::byte> planes(
        gbuffer_bytes(layout, stride, static_cast<uint>(targets.height())));
    for (const PlaneRead& read : targets.reads()) {
        read_plane(targets, read, stride, planes.data() + layout.offset_bytes[read.plane]);
    }
    check_gl_errors("reading the G-buffer");
    return planes;
}

}  // namespace kilolux
