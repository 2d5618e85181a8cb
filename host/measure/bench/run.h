// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "host/measure/bench/row.h"
#include "host/measure/metrics/error_size.h"
#include "host/measure/metrics/rgb_image.h"
#include "host/measure/roofline/limit_watch.h"
#include "host/measure/roofline/roofline.h"
#include "host/picture/frame.h"
#include "host/render/renderer.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

/// What changes from frame to frame, and so must be made anew.
enum class BenchMotion {
    camera,  // camera and lights move a little: nothing is kept
    lights,  // the camera stands
    none,
};

/// How often a point is rendered, and what moves.
struct BenchFrames {
    int warm_up = 30;
    int measured = 120;
    BenchMotion motion = BenchMotion::camera;
};

/// The size of pictures whose error a sweep measures: deferred-all takes a few seconds on a small
/// CPU.
inline constexpr ErrorSizeLimits kBenchErrorSize = {.width = 480, .evaluations = 2e9};

/// Measures points of a sweep over one scene from one camera at one time.
class BenchRun {
 public:
    /// `base`: all settings but the points'. The scene must outlive this.
    /// `gl`: see Renderer.
    BenchRun(const Scene& scene, RenderSettings base, const Camera& camera, double time,
             GlSource gl = GlSource::headless);

    /// Called after every rendered frame; it may throw to stop.
    void on_frame(std::function<void()> call) { on_frame_ = std::move(call); }

    /// A row for each stage, then kOtherStage and kFrameStage. Further frames, not timed, count k*
    /// and measure the error against the all-lights reference.
    std::vector<BenchRow> measure(const SweepPoint& point, const BenchFrames& frames);

    /// How many frames measure() renders for these points.
    std::size_t frame_count(const std::vector<SweepPoint>& points, const BenchFrames& frames) const;

    /// Time of a frame at `point` [ms], from the nearest point measured so far; 0: none was.
    double expected_frame_ms(const SweepPoint& point) const;

    /// The coarse grid of the last point; zeros without one.
    const std::array<std::uint32_t, 3>& grid() const { return grid_; }

    /// The highest rates measured so far.
    const DeviceLimits& limits() const { return watch_.limits(); }

 private:
    using SceneKey = std::tuple<std::array<int, 2>, std::uint64_t, uint>;

    Camera camera_at(BenchMotion motion, int i) const;
    double time_at(BenchMotion motion, int i) const;
    static SceneKey key_of(const SweepPoint& point);
    SweepPoint error_point(SweepPoint point) const;
    Frame render(const RenderSettings& settings);
    const FrameStats& coverage(const SweepPoint& point);
    const RgbImage& reference(const SweepPoint& point);
    PictureError error_of(const SweepPoint& point);
    std::vector<BenchRow> rows_of(const SweepPoint& point, std::vector<FrameStats> frames,
                                  const FrameSetup& setup);

    const Scene& scene_;
    RenderSettings base_;
    Camera camera_;
    double time_;
    std::shared_ptr<RenderScene> opened_;  // by all renderers of the run
    LimitWatch watch_;
    std::function<void()> on_frame_ = [] {};
    std::vector<std::pair<SweepPoint, double>> frame_ms_;
    std::array<std::uint32_t, 3> grid_{};
    std::map<SceneKey, FrameStats> coverages_;  // for counts that no renderer changes
    std::map<SceneKey, RgbImage> references_;
};

}  // namespace kilolux
