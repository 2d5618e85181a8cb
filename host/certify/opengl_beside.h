// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/certify/findings.h"
#include "raster/gl_context.h"

namespace kilolux {

/// Makes the OpenGL context current that a case compares the device with. Without OpenGL the
/// findings say so, and the device alone is certified.
inline std::optional<GlContext> opengl_beside(Findings& findings) {
    try {
        std::optional<GlContext> context(GlContext::headless());
        findings.report("compared with OpenGL", 1.0);
        return context;
    } catch (const Error& error) {
        detail(error.what());
        findings.report("compared with OpenGL", 0.0);
        return std::nullopt;
    }
}

}  // namespace kilolux
