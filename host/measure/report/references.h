// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "host/measure/reference/ray_cast_reference.h"
#include "host/measure/report/picture_errors.h"
#include "host/picture/decoded_surfaces.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

/// The view of a scene that a report is about.
struct ReportView {
    const Scene& scene;
    Camera camera;
    double time = 0.0;  // [s]
};

/// The float64 pictures that a report's settings are compared with, each made once.
///
/// R1 isolates the kernels' arithmetic and culling: the same decoded G-buffer, the same float32
/// lights, the same shading model, every light at every pixel. R2 isolates the G-buffer: rays cast
/// at the pixels' centres, nothing quantised, and the shading model asked for, so that it also has
/// the price of a simpler model. R3 adds the price of the lights' ranges: unbounded inverse square.
class ReportReferences {
 public:
    /// `asked`: the settings asked for, at the size of the comparison. `view.scene` must outlive
    /// this.
    ReportReferences(const ReportView& view, const RenderSettings& asked);

    /// Told before each long computation and, from worker threads, while it runs; may throw.
    void on_step(std::function<void()> call) { on_step_ = std::move(call); }

    const ComparedReference& kernels(const RenderSettings& settings);   // R1
    const ComparedReference& surfaces(const RenderSettings& settings);  // R2, for its ranges
    const ComparedReference& unbounded();                               // R3

    /// The picture asked for, from what the rasteriser drew: R1 of the layout `full` and the
    /// shading model asked for. What is off from it but not R2 is the rasteriser's own.
    const ComparedReference& drawn(const RenderSettings& settings);

    struct All {
        const ComparedReference &kernels, &surfaces, &unbounded;
    };
    All all(const RenderSettings& settings) {
        return {kernels(settings), surfaces(settings), unbounded()};
    }

 private:
    ReferenceOptions options_of(const RenderSettings& settings, bool windowed) const;
    const SurfaceSamples& cast();

    ReportView view_;
    RenderSettings asked_;
    std::function<void()> on_step_ = [] {};
    std::optional<SurfaceSamples> cast_;
    std::map<std::string, ComparedReference> kernels_, surfaces_;
    std::optional<ComparedReference> unbounded_;
};

/// Lights that reach pixels of the reference beyond doubt and are not among those that the device
/// found in the pixels' lists; the sum over all pixels. None when it did not count.
std::optional<std::uint64_t> missed_lights(const DecodedSurfaces& found,
                                           const ReferencePicture& reference);

}  // namespace kilolux
