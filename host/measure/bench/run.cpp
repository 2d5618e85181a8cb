// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/run.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "host/measure/metrics/metrics.h"

namespace kilolux {
namespace {

// A row of a stage's time in each frame that has it.
BenchRow stage_row(BenchRow row, const StageReport& report, const std::vector<FrameStats>& frames) {
    std::vector<double> times_ms;
    for (const FrameStats& frame : frames) {
        for (const StageTime& time : frame.stages) {
            if (time.name == report.stage) times_ms.push_back(time.ms);
        }
    }
    row.stage = report.stage;
    row.ms = statistics(times_ms);
    static_cast<StageEffort&>(row) = report;
    return row;
}

// Makes a row for a time of each frame that belongs to no stage. It has no limit, since some stages
// have none.
template <typename Ms>
BenchRow timed_row(BenchRow row, std::string_view stage, const std::vector<FrameStats>& frames,
                   Ms ms) {
    std::vector<double> times_ms;
    for (const FrameStats& frame : frames) times_ms.push_back(std::invoke(ms, frame));
    row.stage = stage;
    row.ms = statistics(times_ms);
    return row;
}

// How the time of a frame grows between points of the same renderer, roughly.
double relative_work(const SweepPoint& p) {
    const double pixels = static_cast<double>(p.resolution[0]) * p.resolution[1];
    return has_clusters(p.renderer) ? pixels : pixels * static_cast<double>(p.lights + 1);
}

RgbImage picture_of(const Frame& frame) {
    return rgb_image_of(frame.width, frame.height, frame.radiance);
}

// A picture whose every pixel is the mean: errors of darker pixels are relative to it.
RgbImage mean_of(const RgbImage& picture) {
    RgbImage out = picture;
    const double sum = std::accumulate(picture.rgb.begin(), picture.rgb.end(), 0.0);
    const double count = static_cast<double>(std::max<std::size_t>(picture.rgb.size(), 1));
    std::fill(out.rgb.begin(), out.rgb.end(), sum / count);
    return out;
}

}  // namespace

BenchRun::BenchRun(const Scene& scene, RenderSettings base, const Camera& camera, double time,
                   GlSource gl)
    : scene_(scene),
      base_(std::move(base)),
      camera_(camera),
      time_(time),
      opened_(shared_scene(scene, gl)),
      watch_(choose_device(base_.device)) {
    base_.want.aovs.clear();
    if (!base_.opened) base_.opened = std::make_shared<const Gpu>(choose_device(base_.device));
}

// Frame i's camera: to the right by a millionth of the scene's size a frame, far less than a pixel.
Camera BenchRun::camera_at(BenchMotion motion, int i) const {
    Camera camera = camera_;
    if (motion != BenchMotion::camera) return camera;
    const double step = 1e-6 * glm::length(bounds(scene_).size());
    camera.position += i * step * camera.world_from_view[0];
    return camera;
}

double BenchRun::time_at(BenchMotion motion, int i) const {
    constexpr double kFrame = 1.0 / 60.0;  // [s]
    return motion == BenchMotion::none ? time_ : time_ + i * kFrame;
}

std::vector<BenchRow> BenchRun::measure(const SweepPoint& point, const BenchFrames& frames) {
    watch_.look_again();
    RenderSettings settings = settings_at(base_, point);
    settings.want.radiance = false;  // as in a window
    std::vector<FrameStats> measured;
    FrameSetup setup;
    {
        Renderer renderer(opened_, settings);
        setup = frame_setup(settings, renderer.plan(), renderer.device());
        const std::span<uint> picture = renderer.display_memory();
        for (int i = 0; i < frames.warm_up + frames.measured; ++i) {
            Frame frame =
                renderer.render_to(picture, camera_at(frames.motion, i), time_at(frames.motion, i));
            if (i >= frames.warm_up) measured.push_back(std::move(frame.stats));
            on_frame_();
        }
        frame_ms_.emplace_back(point, measured.back().frame_ms);
        std::copy_n(measured.back().grid, 3, grid_.begin());
        if (is_forward(point.renderer)) {
            // A further pass counts, which the timed frames leave out.
            RenderSettings counted = settings;
            counted.want.counts = true;
            renderer.change(counted);
            measured.back().evaluations_per_pixel =
                renderer.render(camera_, time_).stats.evaluations_per_pixel;
            on_frame_();
        }
    }
    return rows_of(point, std::move(measured), setup);
}

std::vector<BenchRow> BenchRun::rows_of(const SweepPoint& point, std::vector<FrameStats> frames,
                                        const FrameSetup& setup) {
    const FrameStats& covered = coverage(point);
    FrameStats stats = frames.back();
    const auto local = static_cast<double>(stats.lights_used - stats.directional_lights);
    if (stats.surface_pixels == 0) stats.surface_pixels = covered.surface_pixels;
    if (point.renderer == RendererKind::deferred_all) stats.evaluations_per_pixel = local;
    stats.useful_evaluations_per_pixel = covered.useful_evaluations_per_pixel;
    stats.shadows = covered.shadows;
    stats.seen_triangles = covered.seen_triangles;
    stats.texels = covered.texels;
    BenchRow row;
    row.point = point;
    row.k = stats.evaluations_per_pixel;
    row.useful_k = covered.useful_evaluations_per_pixel;
    row.error = error_of(point);
    std::vector<BenchRow> rows;
    for (const StageReport& report : stage_reports(stats, limits(), setup)) {
        rows.push_back(stage_row(row, report, frames));
    }
    rows.push_back(timed_row(row, kOtherStage, frames, outside_stages_ms));
    rows.push_back(timed_row(row, kFrameStage, frames, &FrameStats::frame_ms));
    return rows;
}

double BenchRun::expected_frame_ms(const SweepPoint& point) const {
    double ms = 0.0;
    bool same_renderer = false;
    for (const auto& [measured, measured_ms] : frame_ms_) {
        const bool same = measured.renderer == point.renderer;
        if (same_renderer && !same) continue;
        same_renderer = same;
        ms = measured_ms * relative_work(point) / relative_work(measured);
    }
    return ms;
}

std::size_t BenchRun::frame_count(const std::vector<SweepPoint>& points,
                                  const BenchFrames& frames) const {
    std::set<SceneKey> covered, compared;
    std::size_t counted = 0;
    for (const SweepPoint& p : points) {
        counted += is_forward(p.renderer);
        covered.insert(key_of(p));
        compared.insert(key_of(error_point(p)));
    }
    const auto each =
        static_cast<std::size_t>(frames.warm_up) + static_cast<std::size_t>(frames.measured) + 1;
    return points.size() * each + counted + covered.size() + compared.size();
}

BenchRun::SceneKey BenchRun::key_of(const SweepPoint& point) {
    return {point.resolution, point.lights, point.gbuffer};
}

SweepPoint BenchRun::error_point(SweepPoint point) const {
    point.resolution =
        error_size(point.resolution, point.lights + scene_.lights.size(), kBenchErrorSize);
    return point;
}

// Renders a frame that is not timed.
Frame BenchRun::render(const RenderSettings& settings) {
    Frame frame = Renderer(opened_, settings).render(camera_, time_);
    on_frame_();
    return frame;
}

const FrameStats& BenchRun::coverage(const SweepPoint& point) {
    const auto [found, is_new] = coverages_.try_emplace(key_of(point));
    if (!is_new) return found->second;
    RenderSettings settings = settings_at(base_, point);
    settings.renderer = RendererKind::deferred;
    settings.want.counts = settings.want.shadow_counts = true;
    found->second = render(settings).stats;
    return found->second;
}

const RgbImage& BenchRun::reference(const SweepPoint& point) {
    const auto [found, is_new] = references_.try_emplace(key_of(point));
    if (!is_new) return found->second;
    SweepPoint all = point;
    all.renderer = RendererKind::deferred_all;
    all.lanes = 0;
    found->second = picture_of(render(settings_at(base_, all)));
    return found->second;
}

PictureError BenchRun::error_of(const SweepPoint& point) {
    const SweepPoint small = error_point(point);
    const RgbImage picture = picture_of(render(settings_at(base_, small)));
    const RgbImage& expected = reference(small);
    const RgbImage floor = mean_of(expected);
    const HdrMetrics metrics = compare_hdr(picture, expected, {.scale = &floor});
    return {metrics.relative.max, metrics.different_pixels, metrics.pixels};
}

}  // namespace kilolux
