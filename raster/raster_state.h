// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <epoxy/gl.h>

namespace kilolux {

/// Sets the pipeline state of all passes while it lives: image row 0 is row 0 of the framebuffer,
/// depth runs from 1 (near) to 0 (far), the greater wins, back faces are culled, sRGB attachments
/// encode. The destructor restores OpenGL's initial state. The viewport and the bindings of
/// textures, uniform and storage blocks keep the pass's values: callers that share the context must
/// set their own.
class RasterState {
 public:
    RasterState(GLuint framebuffer, int width, int height) {
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
        glViewport(0, 0, width, height);
        glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_GREATER);
        glDepthMask(GL_TRUE);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glEnable(GL_CULL_FACE);
        glCullFace(GL_BACK);
        glFrontFace(GL_CCW);
        glEnable(GL_FRAMEBUFFER_SRGB);
        glDisable(GL_BLEND);
        glDisable(GL_SCISSOR_TEST);
        glDisable(GL_STENCIL_TEST);
        glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    }
    ~RasterState() {
        glUseProgram(0);
        glBindVertexArray(0);
        glDisable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ZERO);  // several targets allow no second source, even if disabled
        glDisable(GL_SCISSOR_TEST);
        glDisable(GL_FRAMEBUFFER_SRGB);
        glDisable(GL_CULL_FACE);
        glFrontFace(GL_CCW);
        glDepthMask(GL_TRUE);
        glDepthFunc(GL_LESS);
        glDisable(GL_DEPTH_TEST);
        glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    }
    RasterState(const RasterState&) = delete;
    RasterState& operator=(const RasterState&) = delete;
};

}  // namespace kilolux
