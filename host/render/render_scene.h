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

/// The OpenGL side of a scene, which stays while settings change.
class RenderScene {
 public:
    /// `own_context`: in an OpenGL context of its own, made when something is drawn, else in the
    /// current one. The scene must outlive this.
    RenderScene(const Scene& scene, bool own_context);
    ~RenderScene();
    RenderScene(const RenderScene&) = delete;
    RenderScene& operator=(const RenderScene&) = delete;

    /// Makes this context current: names of OpenGL's objects belong to a context, so this comes
    /// before they are used or deleted. Does nothing where the context is the caller's.
    void make_current() const;

    /// make_current() for destructors: a lost context took its names with it.
    void make_current_or_lost() const noexcept;

    /// Uploads what moved since, in the current context; see AnimatedScene.
    void take_up_changes();

    const Scene& scene() const { return scene_; }
    const Box& box() const;  // world space [m]
    /// The meshes for this use, uploaded when first asked for. `anisotropy`: see GpuScene. Throws
    /// Error where there is no OpenGL.
    const GpuScene& meshes(GpuSceneUse use, int anisotropy) const;
    /// The most pixels a side that OpenGL draws; 0 where it cannot be used, with a warning that
    /// says why. Makes the context.
    int opengl_limit() const;
    std::size_t zero_normals() const;  // vertices

 private:
    const Scene& scene_;
    SceneRevisions revisions_;  // of the scene as it was uploaded
    bool own_context_;
    // Found when first asked for: not every RenderScene draws.
    mutable std::optional<Box> box_;
    mutable std::optional<std::size_t> zero_normals_;
    mutable bool lacks_opengl_ = false;
    mutable std::optional<GlContext> context_;
    // Destroyed before the context.
    mutable std::map<std::pair<GpuSceneUse, int>, GpuScene> meshes_;
};

}  // namespace kilolux
