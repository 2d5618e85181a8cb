// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <variant>

#include "host/picture/frame_reader.h"
#include "host/render/deferred_path.h"
#include "host/render/forward_path.h"
#include "host/render/light_source.h"
#include "host/render/memory_plan.h"
#include "host/render/render_scene.h"
#include "host/stages/picture/adaptive_samples.h"
#include "host/stages/picture/bloom.h"
#include "host/stages/picture/sum_samples.h"
#include "host/stages/picture/tonemap.h"
#include "raster/overdraw_pass.h"

namespace kilolux {

/// The ways from surfaces to radiance; one for each RendererKind, the forward ones share a class.
using Path = std::variant<DeferredPath, DeferredAllPath, ForwardPath>;

/// Where a frame's display picture goes beside Frame::display: the caller's memory, see
/// Renderer::render_to(); none where it is empty.
using DisplayMemory = std::span<uint>;

/// Adds what the timer measured to the frame's stages.
void add_times(StageTimer& timer, FrameStats& stats);

/// A renderer's stages, built for one device and scene plan.
class Pipeline {
 public:
    /// `opened`: see open_device(). Throws Error as Renderer does.
    Pipeline(std::shared_ptr<RenderScene> the_scene, const RenderSettings& the_settings,
             Gpu opened);
    ~Pipeline();
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;

    /// Makes `pipeline` one for `settings`: the same one where its kernels and device serve.
    static void change(std::unique_ptr<Pipeline>& pipeline,
                       const std::shared_ptr<RenderScene>& scene, const RenderSettings& settings);

    Frame render(const Camera& camera, double time, DisplayMemory memory, int samples);
    PixelProbe probe(int x, int y);
    DisplayMemory display_memory();
    Path& path() { return paths_.at(settings.renderer); }

    bool is_whole() const { return make_bands(settings.height, memory.band_rows).size() == 1; }

    /// Throws Error where the picture is made in bands: what is on the device is the last band's.
    void require_whole(const char* what) const;

    std::shared_ptr<RenderScene> scene;  // first: the last to go
    RenderSettings settings;
    ScenePlan plan;
    Gpu gpu;
    MemoryPlan memory;

 private:
    bool is_built_for(const RenderSettings& other) const;
    void take(const RenderSettings& next);
    void make_optional_parts();
    void make_background();
    void make_reflections();
    // Whether OpenGL's fragments are lit.
    bool lights_on_host() const {
        return is_forward(settings.renderer) || has_blended_surfaces(scene->scene());
    }
    bool blooms_at_end() const { return settings.bloom > 0.0f && !is_whole(); }

    // A picture of which sum_ has the first samples.
    struct Refined {
        RenderSettings settings;
        Camera camera;
        double time = 0.0;  // [s]
        std::uint32_t scene_revision = 0;
        int samples = 0;
        bool operator==(const Refined&) const = default;
    };

    Frame make_frame(const Camera& camera, double time, int samples);
    void refine(const Camera& camera, double time, int samples);
    void keep_refined(const Camera& camera, double time);
    LightInput begin(const Camera& camera, double time, Frame& frame);
    void render_band(const Sample& band, Frame& frame);
    void light_samples(const Sample& band, Measured out, const AfterShading& then);
    void light_until_error(const Sample& band, Measured out, const AfterShading& then);
    Radiance light_sample(const Sample& band, uint number, const NeededTiles* needed, Measured out);
    void develop(const Radiance& radiance, Frame& frame);
    void show(const Radiance& radiance, Frame& frame);
    bool is_written_by_device() const { return gpu.info.is_cpu && !display_memory_.empty(); }
    DisplayTarget display_target(const View& view);
    void bloom_whole(Frame& frame);
    void add_pixels(const Sample& band, Frame& frame);
    void show_view(double time, Frame& frame);
    void read_display(const DisplayTarget& display, Frame& frame);

    Tuning tuning_;
    LightSource lights_;
    std::shared_ptr<SurfaceScene> surface_scene_;
    std::shared_ptr<ShadowScene> shadow_scene_;
    std::optional<FillBackground> background_;       // of settings.background
    std::optional<ReflectEnvironment> reflections_;  // of settings.reflections
    PathContext context_;
    std::map<RendererKind, Path> paths_;   // made when first asked for
    std::unique_ptr<Pipeline> reference_;  // for the view of differences from it
    std::optional<OverdrawPass> overdraw_;
    std::optional<SumSamples> sum_;               // of more samples than one
    std::optional<AdaptiveSamples> until_error_;  // made when first asked for
    std::optional<Bloom> bloom_;                  // none at a share of 0
    Tonemap tonemap_;
    GrowingArray<float> whole_light_;  // of all bands, where bloom mixes them
    FrameReader reader_;
    PinnedMemory shown_;            // display_memory() of a device with memory of its own
    std::vector<uint> host_shown_;  // else
    StageTimer timer_;
    bool is_sound_ = true;  // no render() has failed
    // Of the render() that runs.
    DisplayMemory display_memory_;
    int refining_ = 0;  // samples of a picture that is refined; 0: it is made whole
    int summed_ = 0;    // of them in sum_ before
    std::optional<Refined> refined_;
    // Of the last render().
    LightRows rows_;
    Camera camera_;
    DecodedSurfaces surfaces_;
};

}  // namespace kilolux
