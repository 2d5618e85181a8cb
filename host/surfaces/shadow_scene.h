// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "host/gpu/surface_flow.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

/// Bytes that a ShadowScene takes on the device, about.
std::uint64_t shadow_scene_bytes(const Scene& scene);

/// The shadow casters of a scene on the OpenCL device: all triangles, numbered along the scene's
/// instances; the hierarchy of the boxes of those that hide light; and that of those that tint it,
/// which blend or transmit.
class ShadowScene {
 public:
    /// The scene must outlive this; its meshes must stay as many.
    ShadowScene(const Gpu& gpu, const Scene& scene);

    /// The casters as the scene has them now; rebuilt where its revisions say that surfaces moved.
    /// Materials and textures are not set. Valid until the next call.
    ShadowCasters casters();

    /// How often the hierarchy was built.
    std::uint64_t built() const { return built_; }

    /// From the camera's view space to shadow space.
    ShadowView view(const Camera& camera) const;

 private:
    void build();

    Gpu gpu_;
    const Scene& scene_;
    std::array<std::uint32_t, 2> revision_{};  // of the surfaces
    std::uint64_t built_ = 0;
    glm::dvec3 anchor_{0.0};  // shadow space's origin in the world [m]
    uint levels_ = 0, tint_root_ = 0;
    float extent_ = 0.0f;
    GrowingArray<ShadowNode> nodes_;
    GrowingArray<float> triangles_;
    GrowingArray<MaskedCaster> masked_;
    GrowingArray<TintCaster> tinting_;
};

}  // namespace kilolux
