// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <tuple>
#include <vector>

#include "host/measure/bench/row.h"
#include "host/measure/metrics/rgb_image.h"
#include "host/measure/roofline/limit_watch.h"
#include "host/measure/roofline/roofline.h"
#include "host/picture/frame.h"
#include "host/render/renderer.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

/// How often a point is rendered.
struct BenchFrames {
    int warm_up = 30;
    int measured = 120;
};

/// Size at which pictures are compared: of the same shape, at most 480 pixels wide, and so small
/// that evaluating every light at every pixel stays within two billion evaluations.
std::array<int, 2> error_resolution(std::array<int, 2> resolution, std::uint64_t lights);

/// Measures points of a sweep over one scene from one camera at one time.
class BenchRun {
 public:
    /// `base`: all settings but the points'. The scene must outlive this.
    /// `gl`: see Renderer.
    BenchRun(const Scene& scene, RenderSettings base, const Camera& camera, double time,
             GlSource gl = GlSource::headless);

    /// What is called after every frame that is rendered; it may throw to stop.
    void on_frame(std::function<void()> call) { on_frame_ = std::move(call); }

    /// One row a stage and the frame's last. Beside the timed frames, others find out k* and the
    /// error against the all-lights reference, so that speed never stands without its error.
    std::vector<BenchRow> measure(const SweepPoint& point, const BenchFrames& frames);

    /// Frames that measure() of these points renders in all.
    std::size_t frame_count(const std::vector<SweepPoint>& points, const BenchFrames& frames) const;

    /// As high as they were seen so far.
    const DeviceLimits& limits() const { return watch_.limits(); }

 private:
    // What does not depend on how the lights are found.
    struct Coverage {
        double useful_k = 0.0;
        std::uint64_t drawn_pixels = 0;
    };
    using SceneKey = std::tuple<std::array<int, 2>, std::uint64_t, uint>;

    SweepPoint error_point(SweepPoint point) const;
    const Coverage& coverage(const SweepPoint& point);
    const RgbImage& reference(const SweepPoint& point);
    PictureError error_of(const SweepPoint& point);
    std::vector<BenchRow> rows_of(const SweepPoint& point, std::vector<FrameStats> frames,
                                  const FrameSetup& setup);

    const Scene& scene_;
    RenderSettings base_;
    Camera camera_;
    double time_;
    GlSource gl_;
    LimitWatch watch_;
    std::function<void()> on_frame_ = [] {};
    std::map<SceneKey, Coverage> coverages_;
    std::map<SceneKey, RgbImage> references_;
};

}  // namespace kilolux
