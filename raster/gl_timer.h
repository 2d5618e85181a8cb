// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "raster/gl_object.h"

namespace kilolux {

/// How long the GL takes for what is issued between begin() and end().
class GlTimer {
 public:
    void begin() {
        if (!query_) query_ = make_query(GL_TIME_ELAPSED);
        glBeginQuery(GL_TIME_ELAPSED, query_.name());
    }
    void end() {
        glEndQuery(GL_TIME_ELAPSED);
        used_ = true;
    }

    /// Of the latest begin/end [ms], 0 before the first. Waits for the GL to be done with it.
    double last_ms() const {
        if (!used_) return 0.0;
        GLuint64 elapsed_ns = 0;
        glGetQueryObjectui64v(query_.name(), GL_QUERY_RESULT, &elapsed_ns);
        return static_cast<double>(elapsed_ns) * 1e-6;
    }

 private:
    GlQuery query_;
    bool used_ = false;
};

}  // namespace kilolux
