// SPDX-License-Identifier: Apache-2.0
#include "host/render/render_scene.h"

#include "host/base/error.h"
#include "host/base/log.h"
#include "raster/gbuffer_targets.h"

namespace kilolux {

RenderScene::RenderScene(const Scene& scene, bool own_context)
    : scene_(scene), revisions_(scene.revisions), own_context_(own_context) {}

RenderScene::~RenderScene() { make_current_or_lost(); }

void RenderScene::make_current() const {
    if (context_) context_->make_current();
}

void RenderScene::make_current_or_lost() const noexcept {
    try {
        make_current();
    } catch (const Error& error) {
        detail(error.what());
    }
}

void RenderScene::take_up_changes() {
    const SceneRevisions before = std::exchange(revisions_, scene_.revisions);
    if (before.surfaces() != revisions_.surfaces()) box_ = bounds(scene_);
    const bool same_materials = before.materials == revisions_.materials;
    if (before.geometry == revisions_.geometry && same_materials) return;
    for (auto& [use, meshes] : meshes_) meshes.refresh();
}

const Box& RenderScene::box() const {
    if (!box_) box_ = bounds(scene_);
    return *box_;
}

std::size_t RenderScene::zero_normals() const {
    if (!zero_normals_) zero_normals_ = zero_normal_count(scene_);
    return *zero_normals_;
}

int RenderScene::opengl_limit() const {
    if (lacks_opengl_) return 0;
    try {
        if (own_context_ && !context_) context_.emplace(GlContext::headless());
        return largest_target();
    } catch (const Error& error) {
        lacks_opengl_ = true;
        warn(std::string("OpenCL draws in place of OpenGL: ") + error.what());
        return 0;
    }
}

const GpuScene& RenderScene::meshes(GpuSceneUse use, int anisotropy) const {
    try {
        if (own_context_ && !context_) context_.emplace(GlContext::headless());
    } catch (const Error& error) {
        if (!has_blended_surfaces(scene_)) throw;
        throw Error(std::string("surfaces that blend (alphaMode BLEND) are drawn by OpenGL: ") +
                    error.what());
    }
    return meshes_.try_emplace({use, anisotropy}, scene_, anisotropy, use).first->second;
}

}  // namespace kilolux
