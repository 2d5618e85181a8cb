// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include "kernels/shared/types.h"
#include "raster/gl_object.h"

namespace kilolux {

/// Pictures on their way from the renderer to a texture of the current OpenGL context.
///
/// Each slot is a pixel buffer that stays mapped: the renderer writes to it from its own thread (a
/// CPU device's kernel directly), and OpenGL copies it to the texture.
class PictureBuffers {
 public:
    PictureBuffers() = default;
    ~PictureBuffers();
    PictureBuffers(const PictureBuffers&) = delete;
    PictureBuffers& operator=(const PictureBuffers&) = delete;

    /// A free slot, now in use, with room for `pixels`; none while all are in use. Throws Error
    /// where the driver has no memory for it.
    std::optional<std::size_t> acquire(std::size_t pixels);

    /// The memory of the slot's picture.
    std::span<uint> pixels(std::size_t slot);

    /// Frees a slot whose picture is not wanted.
    void release(std::size_t slot);

    /// Copies the slot's picture, rows display_stride() apart, to the texture. The slot is free
    /// once OpenGL has read it.
    void show(std::size_t slot, int width, int height);

    GLuint texture() const { return texture_.name(); }
    int width() const { return width_; }    // of the texture [pixel], 0 before the first picture
    int height() const { return height_; }  // [pixel]

 private:
    struct Slot {
        GlBuffer buffer;
        std::span<uint> pixels;  // its memory
        GLsync read = nullptr;   // signalled when OpenGL has read the picture
        bool used = false;
    };
    void allocate(Slot& slot, std::size_t pixels);
    bool is_free(Slot& slot);

    std::array<Slot, 4> slots_;
    GlTexture texture_;
    int width_ = 0;
    int height_ = 0;
};

}  // namespace kilolux
