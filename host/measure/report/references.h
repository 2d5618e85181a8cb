// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "host/measure/reference/ray_cast_reference.h"
#include "host/measure/report/mean_picture.h"
#include "host/measure/report/picture_errors.h"
#include "host/picture/decoded_surfaces.h"
#include "host/render/renderer.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

/// The view of a scene that a report is about.
struct ReportView {
    const Scene& scene;
    Camera camera;
    double time = 0.0;                                          // [s]
    std::shared_ptr<RenderScene> opened = shared_scene(scene);  // by all renderers of the report
};

/// What a thread makes the pictures of a report with.
struct ReportDevice {
    std::shared_ptr<const Gpu> gpu;
    std::shared_ptr<RenderScene> opened;  // the scene of the report
};

/// The float64 pictures that a report's settings are compared with; each is made once, R1 once for
/// each kind of device. Several threads may ask at once, each with a device of its own.
///
/// R1 isolates the kernels' arithmetic and culling: the same decoded G-buffer, float32 lights and
/// shading model, every light at every pixel, shadows where the setting has some. R2 isolates the
/// G-buffer and the shading model: rays cast at the pixels' centres, nothing quantised, the model
/// asked for, with the surfaces that blend. A scene with such surfaces has R2, for the setting's
/// shading model, in R1's place, too. R3 adds the error of the lights' ranges: unbounded inverse
/// square.
class ReportReferences {
 public:
    /// `asked`: the settings asked for, at the size of the comparison. `view.scene` must outlive
    /// this.
    ReportReferences(const ReportView& view, const RenderSettings& asked);

    /// Called before each long computation and, from worker threads, while it runs; may throw.
    void on_step(std::function<void()> call) { on_step_ = std::move(call); }

    const ComparedReference& kernels(const RenderSettings& settings, const ReportDevice& device);
    const ComparedReference& surfaces(const RenderSettings& settings);  // R2, for its ranges
    const ComparedReference& unbounded();                               // R3

    /// The picture asked for, from the rasteriser's surfaces: R1 of the layout `full` and the
    /// shading model asked for. It differs from R2 by the rasteriser's error.
    const ComparedReference& rasterised(const RenderSettings& settings, const ReportDevice& device);

    /// R1 with every light that lacks a range reaching everywhere. A picture's difference from it
    /// is the error of ranges, groups and random numbers alone.
    const ComparedReference& unlimited(const RenderSettings& settings, const ReportDevice& device);

    /// The mean of sampled shadows by the settings asked for, whatever their rays.
    const MeanPicture& mean(const ReportDevice& device);

    struct All {
        const ComparedReference &kernels, &surfaces, &unbounded;
    };
    /// `settings`: with an open device.
    All all(const RenderSettings& settings) {
        const ReportDevice device{settings.opened, view_.opened};
        return {kernels(settings, device), surfaces(settings), unbounded()};
    }

 private:
    ReferenceOptions options_of(const RenderSettings& settings, bool windowed) const;
    const std::vector<SurfaceSamples>& cast();
    // Casts rays into the scene, lit with the ranges of `lights` by the model of `shading`.
    ComparedReference cast_reference(const RenderSettings& lights, const RenderSettings& shading,
                                     bool windowed);
    // R1's renderer where the scene has no surfaces that blend.
    ComparedReference decoded_reference(const RenderSettings& decoded, const ReportDevice& device);

    ReportView view_;
    RenderSettings asked_;
    std::mutex mutex_;  // held while a reference is looked for or made
    std::function<void()> on_step_ = [] {};
    std::shared_ptr<const ShadowCaster> shadows_;  // where the settings asked for have some
    std::vector<SurfaceSamples> cast_;             // empty: not yet
    std::map<std::string, ComparedReference> kernels_, surfaces_;
    std::optional<ComparedReference> unbounded_;
    std::map<std::string, MeanPicture> means_;
};

/// Lights that reach a pixel of the reference in any rounding but are not in the pixel's list on
/// the device; the sum over all pixels. None when the device did not count.
std::optional<std::uint64_t> missed_lights(const DecodedSurfaces& found,
                                           const ReferencePicture& reference);

}  // namespace kilolux
