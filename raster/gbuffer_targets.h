// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "host/base/formats/gbuffer_layout.h"
#include "raster/gl_object.h"
#include "raster/gl_program.h"

namespace kilolux {

/// How a plane is read from the framebuffer: glReadPixels of `source` as `format` and `type` yields
/// the plane of kernels/shared/gbuffer.h.
struct PlaneRead {
    uint plane = 0;     // PLANE_*
    GLenum source = 0;  // GL_COLOR_ATTACHMENTi or GL_DEPTH_ATTACHMENT
    GLenum format = 0;
    GLenum type = 0;
};

/// A layout's attachments, and its planes in the order of their ids.
struct TargetPlan {
    std::vector<GLenum> color_formats;  // of GL_COLOR_ATTACHMENT0, 1, ...
    std::vector<PlaneRead> reads;
    Defines defines{};                        // for planes.frag
    std::size_t pixel_bytes = sizeof(float);  // of all attachments, depth included
};

/// The attachments that the geometry pass draws to for these needs. Depth is always
/// DEPTH_COMPONENT32F. Throws UsageError where they need more attachments than OpenGL has.
TargetPlan plan_targets(const GBufferNeeds& needs);

/// The G-buffer's textures in one framebuffer.
class GBufferTargets {
 public:
    /// Throws Error when the driver refuses the framebuffer.
    GBufferTargets(const TargetPlan& plan, int width, int height);

    GLuint framebuffer() const { return framebuffer_.name(); }
    GLuint depth_texture() const { return depth_.name(); }
    GLuint color_texture(std::size_t i) const { return colors_.at(i).name(); }
    std::span<const PlaneRead> reads() const { return reads_; }
    int width() const { return width_; }    // [pixel]
    int height() const { return height_; }  // [pixel]

    /// Sets all planes to 0: no surface.
    void clear() const;

 private:
    std::vector<PlaneRead> reads_;
    std::vector<GLenum> formats_;  // of colors_
    std::vector<GlTexture> colors_;
    GlTexture depth_;
    GlFramebuffer framebuffer_;
    int width_, height_;
};

/// The most pixels a side that the driver can draw.
int largest_target();

/// A texture of one level whose texels are read unfiltered.
GlTexture make_target(GLenum format, int width, int height);

/// Throws Error unless the driver can draw into targets of this size [pixel].
void check_target_size(int width, int height);

/// Neighbouring rows of a target, from the top.
struct RowRange {
    int first = 0;
    int count = 0;  // 0: all
};

/// Reads one plane, rows `stride` elements apart, image rows from the top. `destination` is a host
/// pointer, or an offset where a pixel pack buffer is bound. Elements past the width do not change.
void read_plane(const GBufferTargets& targets, const PlaneRead& read, uint stride,
                void* destination, RowRange rows = {});

/// All planes in host memory, laid out as make_gbuffer_layout() says; 0 past the width.
std::vector<std::byte> read_gbuffer(const GBufferTargets& targets, const GBufferLayout& layout,
                                    uint stride);

}  // namespace kilolux
