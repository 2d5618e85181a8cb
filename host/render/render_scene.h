// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "host/scene/scene.h"
#include "raster/gl_context.h"
#include "raster/gpu_scene.h"

namespace kilolux {

/// A scene on the OpenGL side: what stays while settings change.
class RenderScene {
 public:
    /// `own_context`: in an OpenGL context of its own, made when something is drawn, else in the
    /// current one. The scene must outlive this.
    RenderScene(const Scene& scene, bool own_context);
    ~RenderScene();
    RenderScene(const RenderScene&) = delete;
    RenderScene& operator=(const RenderScene&) = delete;

    /// OpenGL's names are a context's own: before they are used or deleted. Does nothing where the
    /// context is the caller's.
    void make_current() const;

    /// make_current() for destructors: a context that is lost took its names with it.
    void make_current_or_lost() const noexcept;

    /// Takes up what moved since, in the current context; see AnimatedScene.
    void take_up_changes();

    const Scene& scene() const { return scene_; }
    const Box& box() const { return box_; }  // world space [m]
    /// The meshes for this use, uploaded when first asked for. `anisotropy`: see GpuScene. Throws
    /// Error where there is no OpenGL.
    const GpuScene& meshes(GpuSceneUse use, int anisotropy = 0) const;
    /// Whether OpenGL can be used. Makes the context; a warning says why there is none.
    bool has_opengl() const;
    std::size_t zero_normals() const { return zero_normals_; }  // vertices

 private:
    const Scene& scene_;
    std::uint32_t revision_;  // of the scene that was taken up
    Box box_;
    std::size_t zero_normals_;
    bool own_context_;
    mutable bool lacks_opengl_ = false;
    mutable std::optional<GlContext> context_;
    // Gone before the context is.
    mutable std::map<std::pair<GpuSceneUse, int>, GpuScene> meshes_;
};

}  // namespace kilolux
