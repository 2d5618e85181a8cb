// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "raster/gl_context.h"
#include "raster/gl_object.h"

namespace kilolux {

/// Time that OpenGL takes for the commands between begin() and end(). With a driver that draws on
/// the CPU both wait for OpenGL and read the clock: llvmpipe's timer queries leave out the
/// vertices, and give the time of day when a pass spans several of its internal scenes.
class GlTimer {
 public:
    /// begin() and end() of a scope, also where an exception ends it.
    class Scope {
     public:
        explicit Scope(GlTimer& timer) : timer_(timer) { timer_.begin(); }
        ~Scope() { timer_.end(); }
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

     private:
        GlTimer& timer_;
    };

    void begin() {
        if (!query_) {
            query_ = make_query(GL_TIME_ELAPSED);
            software_ = is_software_renderer();
        }
        if (software_) {
            glFinish();
            start_ = Clock::now();
        } else {
            glBeginQuery(GL_TIME_ELAPSED, query_.name());
        }
    }

    void end() {
        if (software_) {
            glFinish();
            elapsed_ms_ = std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
        } else {
            glEndQuery(GL_TIME_ELAPSED);
            pending_ = true;
        }
    }

    /// Time between the latest begin() and end() [ms], 0 before the first. Waits for OpenGL.
    double last_ms() const {
        if (!pending_) return elapsed_ms_;
        GLuint64 elapsed_ns = 0;
        glGetQueryObjectui64v(query_.name(), GL_QUERY_RESULT, &elapsed_ns);
        return static_cast<double>(elapsed_ns) * 1e-6;
    }

 private:
    using Clock = std::chrono::steady_clock;

    GlQuery query_;
    Clock::time_point start_;
    double elapsed_ms_ = 0.0;
    bool software_ = false;
    bool pending_ = false;
};

}  // namespace kilolux
