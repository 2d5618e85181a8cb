// SPDX-License-Identifier: Apache-2.0
#include "raster/gbuffer_targets.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>

#include "host/base/error.h"
#include "raster/gl_context.h"
#include "raster/gl_debug.h"

namespace kilolux {
namespace {

class Planner {
 public:
    explicit Planner(uint layout) {
        plan_.defines.emplace_back("GBUFFER_LAYOUT", std::to_string(layout));
        plan_.reads.push_back({PLANE_DEPTH, GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT, GL_FLOAT});
    }

    // Adds an attachment and returns its index.
    GLenum attach(GLenum format) {
        plan_.color_formats.push_back(format);
        return static_cast<GLenum>(plan_.color_formats.size()) - 1;
    }

    // Adds an attachment that is one plane.
    GLenum attach_plane(uint plane, GLenum internal_format, GLenum format, GLenum type) {
        const GLenum attachment = attach(internal_format);
        plan_.reads.push_back({plane, GL_COLOR_ATTACHMENT0 + attachment, format, type});
        return attachment;
    }

    // A plane that is one component of an attachment: 0 red, 1 green, 2 blue.
    void component(uint plane, GLenum attachment, std::size_t index, GLenum type) {
        constexpr std::array<GLenum, 3> kComponents = {GL_RED, GL_GREEN, GL_BLUE};
        plan_.reads.push_back(
            {plane, GL_COLOR_ATTACHMENT0 + attachment, kComponents.at(index), type});
    }

    // A new attachment whose first components are three planes with ids in a row.
    GLenum attach_vector(uint first_plane, GLenum internal_format, GLenum type) {
        const GLenum attachment = attach(internal_format);
        for (uint i = 0; i < 3; ++i) component(first_plane + i, attachment, i, type);
        return attachment;
    }

    void define(const char* name) { plan_.defines.emplace_back(name, "1"); }

    void define_location(const char* name, GLenum attachment) {
        plan_.defines.emplace_back(name, std::to_string(attachment));
    }

    TargetPlan take() {
        std::stable_sort(plan_.reads.begin(), plan_.reads.end(),
                         [](const PlaneRead& a, const PlaneRead& b) { return a.plane < b.plane; });
        return std::move(plan_);
    }

 private:
    TargetPlan plan_;
};

// The optional 8-bit planes, which all layouts but `full` share.
void attach_optional(Planner& planner, const GBufferNeeds& needs) {
    if (needs.material) {
        planner.define_location(
            "MATERIAL_LOCATION",
            planner.attach_plane(PLANE_MATERIAL, GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE));
    }
    if (needs.occlusion) {
        planner.define_location(
            "OCCLUSION_LOCATION",
            planner.attach_plane(PLANE_OCCLUSION, GL_R8, GL_RED, GL_UNSIGNED_BYTE));
    }
    if (needs.specular) {
        planner.define_location(
            "SPECULAR_LOCATION",
            planner.attach_plane(PLANE_SPECULAR, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE));
    }
}

void plan_packed(Planner& planner, const GBufferNeeds& needs) {
    planner.attach_plane(PLANE_NORMAL, GL_RG16, GL_RG, GL_UNSIGNED_SHORT);
    planner.attach_plane(PLANE_ALBEDO, GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE);
    attach_optional(planner, needs);
}

// World-space position and normal; albedo without the sRGB curve.
void plan_half(Planner& planner, const GBufferNeeds& needs) {
    planner.define("POSITION");
    planner.attach_vector(PLANE_POSITION_X, GL_RGBA16F, GL_HALF_FLOAT);
    planner.attach_vector(PLANE_NORMAL_X, GL_RGBA16F, GL_HALF_FLOAT);
    planner.attach_plane(PLANE_ALBEDO, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE);
    attach_optional(planner, needs);
}

void plan_oct_2x4(Planner& planner, const GBufferNeeds& needs) {
    planner.define("POSITION");
    planner.attach_plane(PLANE_ROW_0, GL_RGBA32F, GL_RGBA, GL_FLOAT);
    planner.attach_plane(PLANE_ROW_1, GL_RGBA32F, GL_RGBA, GL_FLOAT);
    attach_optional(planner, needs);
}

// Only red, green and blue are used: reading alpha alone is not in OpenGL's core profile.
void plan_full(Planner& planner, const GBufferNeeds& needs) {
    planner.define("POSITION");
    planner.attach_vector(PLANE_POSITION_X, GL_RGBA32F, GL_FLOAT);
    planner.attach_vector(PLANE_NORMAL_X, GL_RGBA32F, GL_FLOAT);
    planner.attach_vector(PLANE_ALBEDO_R, GL_RGBA32F, GL_FLOAT);
    const GLenum parameters = planner.attach(GL_RGBA32F);
    planner.component(PLANE_ROUGHNESS, parameters, 0, GL_FLOAT);
    if (needs.material) planner.component(PLANE_METALLIC, parameters, 1, GL_FLOAT);
    if (needs.occlusion) planner.component(PLANE_OCCLUSION_F, parameters, 2, GL_FLOAT);
    if (needs.material) {
        planner.define_location("MATERIAL_LOCATION",
                                planner.attach_vector(PLANE_EMISSIVE_R, GL_RGBA32F, GL_FLOAT));
    }
    if (needs.specular) {
        planner.define_location("SPECULAR_LOCATION",
                                planner.attach_vector(PLANE_SPECULAR_R, GL_RGBA32F, GL_FLOAT));
        planner.define_location(
            "GRAZING_LOCATION",
            planner.attach_plane(PLANE_SPECULAR_F90, GL_R32F, GL_RED, GL_FLOAT));
    }
}

GlTexture make_target(GLenum format, int width, int height) {
    GlTexture texture = make_texture(GL_TEXTURE_2D);
    glTextureStorage2D(texture.name(), 1, format, width, height);
    glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

}  // namespace

TargetPlan plan_targets(const GBufferNeeds& needs) {
    Planner planner(needs.layout);
    if (needs.specular) planner.define("HAS_SPECULAR");
    if (needs.unlit) planner.define("HAS_UNLIT");
    switch (needs.layout) {
        case GBUFFER_FULL:
            plan_full(planner, needs);
            break;
        case GBUFFER_HALF:
            plan_half(planner, needs);
            break;
        case GBUFFER_OCT_2X4:
            plan_oct_2x4(planner, needs);
            break;
        default:  // normal-xy differs in what the shader writes
            plan_packed(planner, needs);
    }
    return planner.take();
}

TargetPlan plan_id_targets() {
    return {{GL_R32UI}, {{0, GL_COLOR_ATTACHMENT0, GL_RED_INTEGER, GL_UNSIGNED_INT}}, {}};
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
    const std::string what =
        "G-buffer of " + std::to_string(width) + "x" + std::to_string(height) + " pixels";
    check_gl_errors(what);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        throw Error(what + ": framebuffer status is " + std::to_string(status));
    }
}

void GBufferTargets::clear() const {
    constexpr std::array<GLfloat, 4> kZero = {};
    constexpr std::array<GLuint, 4> kNone = {};
    for (std::size_t i = 0; i < colors_.size(); ++i) {
        const auto drawbuffer = static_cast<GLint>(i);
        if (formats_[i] == GL_R32UI) {
            glClearNamedFramebufferuiv(framebuffer_.name(), GL_COLOR, drawbuffer, kNone.data());
        } else {
            glClearNamedFramebufferfv(framebuffer_.name(), GL_COLOR, drawbuffer, kZero.data());
        }
    }
    glClearNamedFramebufferfv(framebuffer_.name(), GL_DEPTH, 0, kZero.data());
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

namespace {

// llvmpipe reads pixels fast, and converts what it reads from textures.
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
                void* destination) {
    read_plane(targets, read, stride, {0, targets.height()}, destination);
}

void read_plane(const GBufferTargets& targets, const PlaneRead& read, uint stride, RowRange rows,
                void* destination) {
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
