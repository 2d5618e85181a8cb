// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "kernels/shared/types.h"
#include "raster/gl_object.h"

namespace kilolux {

/// Pictures on their way from the renderer to a texture of the current OpenGL context.
///
/// Each of a few slots is a pixel buffer of OpenGL that stays mapped: the renderer writes there
/// from its own thread (a CPU device's kernel directly), and OpenGL copies from it to the texture.
/// Where a driver cannot map one for good, slots are plain memory, which costs a copy more.
class PictureBuffers {
 public:
    PictureBuffers();
    ~PictureBuffers();
    PictureBuffers(const PictureBuffers&) = delete;
    PictureBuffers& operator=(const PictureBuffers&) = delete;

    /// A slot that nobody uses, with room for `pixels`; none while all are in use.
    std::optional<std::size_t> acquire(std::size_t pixels);

    /// Where to write the slot's picture.
    std::span<uint> pixels(std::size_t slot);

    /// Gives back a slot whose picture nobody wants.
    void release(std::size_t slot);

    /// Brings the slot's picture, rows display_stride() apart, to the texture; the slot is free
    /// again when OpenGL has read it.
    void show(std::size_t slot, int width, int height);

    GLuint texture() const { return texture_.name(); }
    int width() const { return width_; }    // of the texture [pixel], 0 before the first picture
    int height() const { return height_; }  // [pixel]
    bool is_mapped() const { return mapped_; }
    std::size_t bytes() const;

 private:
    struct Slot {
        GlBuffer buffer;  // none: `memory` instead
        std::vector<uint> memory;
        std::span<uint> pixels;
        GLsync read = nullptr;  // signalled when OpenGL has read the picture
        bool used = false;
    };
    void allocate(Slot& slot, std::size_t pixels);
    bool is_free(Slot& slot);

    std::array<Slot, 4> slots_;
    GlTexture texture_;
    int width_ = 0;
    int height_ = 0;
    bool mapped_ = true;
};

}  // namespace kilolux
