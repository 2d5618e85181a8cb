// SPDX-License-Identifier: Apache-2.0
#include "raster/gbuffer_targets.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "host/base/error.h"
#include "raster/gl_context.h"
#include "raster/gl_debug.h"

namespace kilolux {
namespace {

// An attachment and the planes that it or its components are. The macro that tells geometry.frag
// its index is for those that not every G-buffer has.
struct Attachment {
    GLenum internal_format = 0;
    std::vector<PlaneRead> reads;
    std::string_view location = {};
};

// An attachment that is one plane.
Attachment one_plane(uint id, GLenum internal_format, GLenum format, GLenum type,
                     std::string_view location = {}) {
    return {internal_format, {{id, 0, format, type}}, location};
}

// An attachment whose red, green and blue are three planes with ids in a row.
Attachment three_planes(uint first, GLenum internal_format, GLenum type,
                        std::string_view location = {}) {
    return {
        internal_format,
        {{first, 0, GL_RED, type}, {first + 1, 0, GL_GREEN, type}, {first + 2, 0, GL_BLUE, type}},
        location};
}

constexpr std::string_view kMaterialLocation = "MATERIAL_LOCATION";
constexpr std::string_view kOcclusionLocation = "OCCLUSION_LOCATION";
constexpr std::string_view kSpecularLocation = "SPECULAR_LOCATION";
constexpr std::string_view kGrazingLocation = "GRAZING_LOCATION";

// Only red, green and blue are used: reading alpha alone is not in OpenGL's core profile.
std::vector<Attachment> full_attachments(const GBufferNeeds& needs) {
    Attachment parameters = one_plane(PLANE_ROUGHNESS, GL_RGBA32F, GL_RED, GL_FLOAT);
    if (needs.material) parameters.reads.push_back({PLANE_METALLIC, 0, GL_GREEN, GL_FLOAT});
    if (needs.occlusion) parameters.reads.push_back({PLANE_OCCLUSION_F, 0, GL_BLUE, GL_FLOAT});
    std::vector<Attachment> out = {three_planes(PLANE_POSITION_X, GL_RGBA32F, GL_FLOAT),
                                   three_planes(PLANE_NORMAL_X, GL_RGBA32F, GL_FLOAT),
                                   three_planes(PLANE_ALBEDO_R, GL_RGBA32F, GL_FLOAT), parameters};
    if (needs.material) {
        out.push_back(three_planes(PLANE_EMISSIVE_R, GL_RGBA32F, GL_FLOAT, kMaterialLocation));
    }
    if (needs.specular) {
        out.push_back(three_planes(PLANE_SPECULAR_R, GL_RGBA32F, GL_FLOAT, kSpecularLocation));
        out.push_back(one_plane(PLANE_SPECULAR_F90, GL_R32F, GL_RED, GL_FLOAT, kGrazingLocation));
    }
    return out;
}

// What every G-buffer of the layout has.
std::vector<Attachment> common_attachments(uint layout) {
    if (layout == GBUFFER_HALF) {  // position and normal of the world; albedo without sRGB's curve
        return {three_planes(PLANE_POSITION_X, GL_RGBA16F, GL_HALF_FLOAT),
                three_planes(PLANE_NORMAL_X, GL_RGBA16F, GL_HALF_FLOAT),
                one_plane(PLANE_ALBEDO, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE)};
    }
    if (layout == GBUFFER_OCT_2X4) {
        return {one_plane(PLANE_ROW_0, GL_RGBA32F, GL_RGBA, GL_FLOAT),
                one_plane(PLANE_ROW_1, GL_RGBA32F, GL_RGBA, GL_FLOAT)};
    }
    // normal-xy differs from packed in what the shader writes.
    return {one_plane(PLANE_NORMAL, GL_RG16, GL_RG, GL_UNSIGNED_SHORT),
            one_plane(PLANE_ALBEDO, GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE)};
}

// All layouts but `full` have the same optional planes, of 8 bits a channel.
std::vector<Attachment> attachments_of(const GBufferNeeds& needs) {
    if (needs.layout == GBUFFER_FULL) return full_attachments(needs);
    std::vector<Attachment> out = common_attachments(needs.layout);
    const auto add = [&out](uint id, GLenum internal_format, GLenum format,
                            std::string_view location) {
        out.push_back(one_plane(id, internal_format, format, GL_UNSIGNED_BYTE, location));
    };
    if (needs.material) add(PLANE_MATERIAL, GL_SRGB8_ALPHA8, GL_RGBA, kMaterialLocation);
    if (needs.occlusion) add(PLANE_OCCLUSION, GL_R8, GL_RED, kOcclusionLocation);
    if (needs.specular) add(PLANE_SPECULAR, GL_RGBA8, GL_RGBA, kSpecularLocation);
    return out;
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
    const std::vector<Attachment> attachments = attachments_of(needs);
    TargetPlan plan;
    plan.reads_position = needs.layout == GBUFFER_FULL || needs.layout == GBUFFER_HALF ||
                          needs.layout == GBUFFER_OCT_2X4;
    plan.defines = {{"GBUFFER_LAYOUT", fmt::to_string(needs.layout)},
                    {"HAS_SPECULAR", needs.specular ? "1" : "0"},
                    {"HAS_UNLIT", needs.unlit ? "1" : "0"}};
    plan.reads = {{PLANE_DEPTH, GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT, GL_FLOAT}};
    for (const Attachment& attachment : attachments) {
        const auto index = static_cast<GLenum>(plan.color_formats.size());
        plan.color_formats.push_back(attachment.internal_format);
        for (PlaneRead read : attachment.reads) {
            read.source = GL_COLOR_ATTACHMENT0 + index;
            plan.reads.push_back(read);
        }
    }
    std::ranges::stable_sort(plan.reads, {}, &PlaneRead::plane);
    for (const std::string_view location :
         {kMaterialLocation, kOcclusionLocation, kSpecularLocation, kGrazingLocation}) {
        const auto found = std::ranges::find(attachments, location, &Attachment::location);
        std::optional<std::string> index;
        if (found != attachments.end()) index = fmt::to_string(found - attachments.begin());
        define_optional(plan.defines, std::string(location), index);
    }
    return plan;
}

TargetPlan plan_id_targets() {
    return {{GL_R32UI}, {{0, GL_COLOR_ATTACHMENT0, GL_RED_INTEGER, GL_UNSIGNED_INT}}};
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
    throw Error(fmt::format("resolution {}x{} pixels: this OpenGL draws 1 to {} a side", width,
                            height, largest));
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
