// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/scene/scene.h"
#include "raster/gl_context.h"
#include "raster/gpu_scene.h"

namespace kilolux {

/// A scene on the OpenGL side: what stays while settings change.
struct RenderScene {
    /// `own_context`: in an OpenGL context of its own, else in the current one. The scene must
    /// outlive this.
    RenderScene(const Scene& the_scene, bool own_context)
        : scene(the_scene), box(bounds(the_scene)) {
        if (own_context) context.emplace(GlContext::headless());
        meshes.emplace(the_scene);
    }

    const Scene& scene;
    Box box;  // world space [m]
    std::optional<GlContext> context;
    std::optional<GpuScene> meshes;  // gone before the context is
};

}  // namespace kilolux
