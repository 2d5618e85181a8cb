// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "host/gpu/device.h"
#include "host/render/frame.h"
#include "host/render/frame_parts.h"
#include "host/render/memory_plan.h"
#include "host/render/scene_plan.h"
#include "host/render/settings.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

/// What list_devices() says of every OpenCL device, in the order that `--device INDEX` counts.
std::vector<DeviceInfo> list_devices();

/// Where the renderer's OpenGL context comes from.
enum class GlSource {
    headless,  // the renderer makes its own
    current,   // the caller's, current now and at every render()
};

/// Renders one scene: the whole data flow, from meshes and lights to pixels. Between frames the scene
/// may change as AnimatedScene changes it: what its revisions say is new is taken up.
class Renderer {
 public:
    /// Compiles for the scene and uploads it. The scene must outlive the renderer. Throws Error
    /// when a device, GL or a build fails.
    Renderer(const Scene& scene, const RenderSettings& settings, GlSource gl = GlSource::headless);
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// The picture at `time` [s]: the mean of settings.samples jittered samples (sample_pattern.h).
    /// AOVs, views and counts are those of the sample through the pixels' centres; stage times are
    /// sums over the samples and bands. Blocks until it is on the host. The same arguments give the
    /// same bits on every call and with any memory. `between` is called before every band, and what
    /// it throws comes out.
    Frame render(const Camera& camera, double time, const std::function<void()>& between = {});

    /// What the last render() shaded, decoded, and the lights as its kernels saw them: what a float64
    /// reference of the kernels starts from. Throws Error for the forward renderers, which keep no
    /// G-buffer, and for pictures made in bands.
    LitSurfaces lit_surfaces();

    const DeviceInfo& device() const;
    const ScenePlan& plan() const;
    const MemoryPlan& memory() const;

 private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace kilolux
