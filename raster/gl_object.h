// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <epoxy/gl.h>

#include <utility>

namespace kilolux {

/// Owner of one OpenGL object name; 0 owns nothing. The context that made it must be current when
/// it is destroyed.
template <void (*Delete)(GLuint)>
class GlObject {
 public:
    GlObject() = default;
    explicit GlObject(GLuint name) : name_(name) {}
    GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    GlObject(const GlObject&) = delete;
    GlObject& operator=(const GlObject&) = delete;
    ~GlObject() {
        if (name_ != 0) Delete(name_);
    }

    GLuint name() const { return name_; }
    explicit operator bool() const { return name_ != 0; }

 private:
    GLuint name_ = 0;
};

namespace gl_delete {
inline void texture(GLuint name) { glDeleteTextures(1, &name); }
inline void buffer(GLuint name) { glDeleteBuffers(1, &name); }
inline void framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
inline void vertex_array(GLuint name) { glDeleteVertexArrays(1, &name); }
inline void query(GLuint name) { glDeleteQueries(1, &name); }
inline void shader(GLuint name) { glDeleteShader(name); }
inline void program(GLuint name) { glDeleteProgram(name); }
}  // namespace gl_delete

using GlTexture = GlObject<gl_delete::texture>;
using GlBuffer = GlObject<gl_delete::buffer>;
using GlFramebuffer = GlObject<gl_delete::framebuffer>;
using GlVertexArray = GlObject<gl_delete::vertex_array>;
using GlQuery = GlObject<gl_delete::query>;
using GlShader = GlObject<gl_delete::shader>;
using GlProgram = GlObject<gl_delete::program>;

/// Makes one object in the current context.
template <typename Object, typename Create>
Object made_by(Create create) {
    GLuint name = 0;
    create(1, &name);
    return Object(name);
}
inline GlTexture make_texture(GLenum target) {
    return made_by<GlTexture>([=](GLsizei n, GLuint* name) { glCreateTextures(target, n, name); });
}
inline GlQuery make_query(GLenum target) {
    return made_by<GlQuery>([=](GLsizei n, GLuint* name) { glCreateQueries(target, n, name); });
}
inline GlBuffer make_buffer() { return made_by<GlBuffer>(glCreateBuffers); }
inline GlFramebuffer make_framebuffer() { return made_by<GlFramebuffer>(glCreateFramebuffers); }
inline GlVertexArray make_vertex_array() { return made_by<GlVertexArray>(glCreateVertexArrays); }

}  // namespace kilolux
