// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/picture_buffers.h"

#include "host/render/renderer.h"
#include "raster/gl_debug.h"

namespace kilolux {

PictureBuffers::~PictureBuffers() {
    for (Slot& slot : slots_) {
        if (slot.read != nullptr) glDeleteSync(slot.read);
    }
}

void PictureBuffers::allocate(Slot& slot, std::size_t pixels) {
    constexpr GLbitfield kAccess =
        GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    const auto bytes = static_cast<GLsizeiptr>(pixels * sizeof(uint));
    slot = Slot{make_buffer(), {}};
    glNamedBufferStorage(slot.buffer.name(), bytes, nullptr, kAccess | GL_CLIENT_STORAGE_BIT);
    auto* mapping =
        static_cast<uint*>(glMapNamedBufferRange(slot.buffer.name(), 0, bytes, kAccess));
    check_gl_errors("picture buffer");
    slot.pixels = {mapping, pixels};
}

bool PictureBuffers::is_free(Slot& slot) {
    if (slot.used) return false;
    if (slot.read == nullptr) return true;
    const GLenum state = glClientWaitSync(slot.read, GL_SYNC_FLUSH_COMMANDS_BIT, 0);
    if (state == GL_TIMEOUT_EXPIRED) return false;
    glDeleteSync(slot.read);
    slot.read = nullptr;
    return true;
}

std::optional<std::size_t> PictureBuffers::acquire(std::size_t pixels) {
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        if (!is_free(slots_[i])) continue;
        if (slots_[i].pixels.size() < pixels) allocate(slots_[i], pixels);
        slots_[i].used = true;
        return i;
    }
    return std::nullopt;
}

std::span<uint> PictureBuffers::pixels(std::size_t slot) { return slots_.at(slot).pixels; }

void PictureBuffers::release(std::size_t slot) { slots_.at(slot).used = false; }

void PictureBuffers::show(std::size_t index, int width, int height) {
    Slot& slot = slots_.at(index);
    if (!texture_ || width != width_ || height != height_) {
        texture_ = make_texture(GL_TEXTURE_2D);
        glTextureStorage2D(texture_.name(), 1, GL_RGBA8, width, height);
        glTextureParameteri(texture_.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTextureParameteri(texture_.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        glTextureParameteri(texture_.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTextureParameteri(texture_.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
        width_ = width;
        height_ = height;
    }
    glPixelStorei(GL_UNPACK_ROW_LENGTH, static_cast<GLint>(display_stride(width)));
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, slot.buffer.name());
    glTextureSubImage2D(texture_.name(), 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE,
                        nullptr);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    slot.read = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    slot.used = false;
    check_gl_errors("picture texture");
}

}  // namespace kilolux
