// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "host/base/spares.h"
#include "host/gpu/device.h"
#include "host/picture/bands.h"
#include "host/picture/crop.h"
#include "host/picture/decoded_surfaces.h"
#include "host/picture/frame.h"
#include "host/picture/pixel_probe.h"
#include "host/picture/shared_picture.h"
#include "host/render/plan/memory_plan.h"
#include "host/render/plan/scene_plan.h"
#include "host/render/settings.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

struct Pipeline;
class RenderScene;

/// Properties of every OpenCL device, in the order in which `--device INDEX` counts.
std::vector<DeviceInfo> list_devices();

/// Where the renderer's OpenGL context comes from.
enum class GlSource {
    headless,  // the renderer makes its own
    current,   // the caller's, current now and at every render()
};

/// The OpenGL objects of a scene, for renderers that share it: a context, meshes and textures, made
/// when first needed. The scene must outlive it.
std::shared_ptr<RenderScene> shared_scene(const Scene& scene, GlSource gl = GlSource::headless);

/// Pixels from a row of a display picture to the next, as render_to() writes them.
std::size_t display_stride(int width);

/// Renders one scene: the whole data flow, from meshes and lights to pixels. Between frames the
/// scene may change as AnimatedScene changes it: its revisions say what is taken over.
class Renderer {
 public:
    /// Compiles for the scene and uploads it. The scene must outlive the renderer. Throws Error
    /// when a device, GL or a build fails.
    Renderer(const Scene& scene, const RenderSettings& settings, GlSource gl = GlSource::headless);
    /// The same on the device that settings.device names, which is open already.
    Renderer(const Scene& scene, const RenderSettings& settings, const Gpu& opened);
    /// The same for a scene that other renderers use, too, one at a time.
    Renderer(std::shared_ptr<RenderScene> scene, const RenderSettings& settings);
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// Renders with other settings from now on. Meshes and textures stay. Kernels and shaders are
    /// built anew only where the device, the scene plan or the renderer changes, and are kept for a
    /// return to an earlier renderer. Throws Error as the constructor does; then the former
    /// settings hold.
    void change(const RenderSettings& settings);

    /// Call after lights of the scene were added or replaced: builds anew where the scene plan
    /// needs it, as for the first spot light.
    void refit();

    const RenderSettings& settings() const;
    const Scene& scene() const;

    /// What settings().want asks for of the picture at `time` [s]: the mean of settings.samples
    /// jittered samples (sample_pattern.h), or of settings.auto_samples. AOVs, views and counts are
    /// those of the sample through the pixels' centres; stage times are sums over the samples and
    /// bands. Blocks until it is on the host. The same arguments give the same bits on every call
    /// and with any memory. Between samples, bands and parts of a slow pass it calls
    /// check_interrupt().
    Frame render(const Camera& camera, double time);

    /// As render(), but the display picture goes to `pixels` (R | G << 8 | B << 16 | A << 24, rows
    /// display_stride() apart, height rows) and the radiance stays on the device: Frame::display
    /// and Frame::radiance are empty. A device that shares the host's memory writes there itself.
    ///
    /// `samples` above 0: the mean of only the first of settings().samples, to be refined by calls
    /// with more: those that the last call had of the same picture are kept. Their sum has more
    /// bits than float64 and is rounded once, so the last one's picture is render()'s. A picture in
    /// bands, or of another view, is made whole.
    Frame render_to(std::span<uint> pixels, const Camera& camera, double time, int samples = 0);

    /// A strip of the picture of render(): a frame of its own of these rows, which have the same
    /// bits; its counts and times are those of the strip. Throws Error where a view or a stage such
    /// as bloom needs the whole picture. Blocks; calls check_interrupt() as render() does.
    Frame render_strip(const Camera& camera, double time, Band rows);

    /// The pixels of `rect` of the picture of render(), as a frame of their own with the same bits.
    /// Makes whole rows, and where a view or a stage such as bloom needs it the whole picture;
    /// counts and times are those of what it makes. Throws Error for pixels that the picture does
    /// not have. Blocks; calls check_interrupt() as render() does.
    Frame render_crop(const Camera& camera, double time, const PixelRect& rect);

    /// The strips of a picture from the top; one, the whole, unless it is too large for the host or
    /// for one piece.
    std::vector<Band> strips() const;

    /// Begins a picture that this renderer and others make by rows, with render()'s bits: renderers
    /// of the same scene with the same settings, but for the device.
    std::unique_ptr<SharedPicture> begin_rows() const;

    /// Makes rows of such a picture and returns what it counted and measured; other renderers may
    /// make other rows meanwhile. Rows begin at a multiple of MemoryPlan::least_rows, and end at
    /// one or with the picture. Blocks; calls check_interrupt() as render() does.
    FrameStats render_rows(SharedPicture& picture, const Camera& camera, double time, Band rows);

    /// When all rows are made: adds what needs the whole picture, as bloom. One of the renderers
    /// does it; picture.frame, but for its stats, then is render()'s.
    FrameStats finish_rows(SharedPicture& picture, const Camera& camera, double time);

    /// Gets frames of render() and render_strip() that are done with: further ones take their
    /// memory. Outlives the renderer.
    std::shared_ptr<Spares<Frame>> spare_frames() const;

    /// Memory for render_to() that the device copies to at the full rate of its bus. Valid until it
    /// is asked for again or change().
    std::span<uint> display_memory();

    /// The surfaces and lights of the last render(), decoded as its kernels saw them: the input of
    /// a float64 reference of the kernels. Throws Error for the forward renderers, which keep no
    /// G-buffer, and for pictures made in bands.
    LitSurfaces lit_surfaces();

    /// The surface at a pixel of the last render, and the lights in its list. Blocks. Throws Error
    /// for pictures made in bands.
    PixelProbe probe(int x, int y);

    /// The active clusters of the last render, in its camera's view space; none unless the renderer
    /// is `deferred`. Blocks.
    std::vector<ActiveCluster> active_clusters() const;

    /// Number of lights with `settings`, the scene's own and the generated ones.
    std::uint64_t light_count(const RenderSettings& settings) const;

    const DeviceInfo& device() const;
    const ScenePlan& plan() const;
    const Gpu& gpu() const;
    const MemoryPlan& memory() const;

 private:
    std::unique_ptr<Pipeline> pipeline_;
};

}  // namespace kilolux
