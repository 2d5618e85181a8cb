// SPDX-License-Identifier: Apache-2.0
#include "host/measure/photometry/point_lighting.h"

#include <algorithm>
#include <numbers>

#include "host/base/formats/gbuffer_layout.h"
#include "host/base/system/interrupt.h"
#include "host/measure/metrics/rgb_image.h"
#include "host/render/plan/kernel_choice.h"
#include "host/render/plan/scene_plan.h"
#include "host/scene/lights/light_kinds.h"

namespace kilolux {
namespace {

constexpr uint kFrameTiles = 16;  // across
constexpr std::size_t kFramePoints = kGroupPoints * kFrameTiles * kFrameTiles;
static_assert(kGroupPoints == FINE_TILE_PIXELS);

// All lights are the scene's, each with its own range or none, and with the intensity that it has.
RenderSettings light_settings(RenderSettings settings) {
    settings.lights = {};
    settings.lights.count = 0;
    settings.light_mix = {};
    settings.light_groups.clear();
    settings.tails = Tails::exact;
    settings.shading = Shading::lambert;
    settings.shadows = Shadows::off;
    settings.gbuffer = GBUFFER_FULL;
    settings.ambient = 0.0f;
    settings.force_features.clear();
    settings.want = {};
    return settings;
}

// Kernel features that lights need; materials are left out.
KernelFeatures point_features(const Scene& scene, const RenderSettings& settings) {
    KernelFeatures out = make_scene_plan(scene, settings, scene.lights.size()).kernels;
    const SceneFeatures all = out;
    static_cast<SceneFeatures&>(out) = SceneFeatures();
    for (const LightKind& kind : kLightKinds) out.*kind.feature = all.*kind.feature;
    out.light_profiles = all.light_profiles;
    out.wide_light_index = all.wide_light_index;
    out.light_d_min = all.light_d_min;
    return out;
}

// A parallel camera that sees the points of a frame, along the world's axes.
Camera camera_around(const Box& box) {
    Camera camera;
    camera.position = box.center();
    camera.orthographic = true;
    // 1 cm: a frame of one point has a size, too.
    const double radius = std::max(0.5 * glm::length(box.size()), 0.01);
    camera.y_extent = radius;
    camera.z_near = radius;
    camera.z_far = 2.0 * radius;
    return camera;
}

// The planes of a frame's points: point i is pixel i of the tiles one after the other.
class PointGBuffer {
 public:
    PointGBuffer(const View& view, const KernelFeatures& features)
        : view_(view),
          layout_(full_gbuffer_layout(features, view.stride, view.height)),
          bytes_(gbuffer_bytes(layout_, view.stride, view.height)) {}

    std::size_t pixel(std::size_t i) const {
        const std::size_t tile = i / kGroupPoints, within = i % kGroupPoints;
        const std::size_t across = view_.stride / FINE_TILE;
        const std::size_t x = tile % across * FINE_TILE + within % FINE_TILE;
        return (tile / across * FINE_TILE + within / FINE_TILE) * view_.stride + x;
    }

    void put(std::size_t i, const MeasuringPoint& point, const glm::dvec3& center) {
        const std::size_t at = pixel(i);
        plane(PLANE_DEPTH)[at] = 1.0f;
        put(PLANE_POSITION_X, at, point.position - center);
        put(PLANE_NORMAL_X, at, point.normal);
        put(PLANE_ALBEDO_R, at, glm::dvec3(1.0));
        plane(PLANE_ROUGHNESS)[at] = 1.0f;
    }

    const std::vector<std::byte>& bytes() const { return bytes_; }
    const GBufferLayout& layout() const { return layout_; }

 private:
    float* plane(uint number) {
        return reinterpret_cast<float*>(&bytes_[layout_.offset_bytes[number]]);
    }

    void put(uint first, std::size_t at, const glm::dvec3& v) {
        for (uint c = 0; c < 3; ++c) {
            plane(first + c)[at] = static_cast<float>(v[static_cast<glm::length_t>(c)]);
        }
    }

    View view_;
    GBufferLayout layout_{};
    std::vector<std::byte> bytes_;
};

}  // namespace

PointLighting::PointLighting(const Scene& scene, const RenderSettings& settings)
    : settings_(light_settings(settings)),
      gpu_(open_device(settings)),
      tuning_(choose_tuning(gpu_.info, settings.kernels).tuning),
      features_(point_features(scene, settings_)),
      lights_(gpu_, tuning_, scene, settings_),
      lighting_(gpu_, tuning_, features_),
      planes_(gpu_, "photometry") {}

std::vector<double> PointLighting::illuminance(std::span<const MeasuringPoint> points,
                                               std::span<const std::uint32_t> order) {
    std::vector<double> out(points.size(), 0.0);
    for (std::size_t first = 0; first < order.size(); first += kFramePoints) {
        check_interrupt();
        light_frame(points, order.subspan(first, std::min(kFramePoints, order.size() - first)),
                    out);
    }
    return out;
}

void PointLighting::light_frame(std::span<const MeasuringPoint> points,
                                std::span<const std::uint32_t> frame, std::vector<double>& out) {
    Box box;
    for (const std::uint32_t i : frame) box.add(points[i].position);
    const Camera camera = camera_around(box);
    const auto tiles = static_cast<uint>((frame.size() + kGroupPoints - 1) / kGroupPoints);
    const uint across = std::min(tiles, kFrameTiles);
    const uint down = (tiles + across - 1) / across;
    const View view =
        view_of(camera, static_cast<int>(across * FINE_TILE), static_cast<int>(down * FINE_TILE));
    PointGBuffer planes(view, features_);
    for (std::size_t i = 0; i < frame.size(); ++i) {
        planes.put(i, points[frame[i]], camera.position);
    }
    const DeviceArray<std::byte> bytes = planes_.reserve(planes.bytes().size());
    upload<std::byte>(gpu_, bytes.buffer(), planes.bytes());

    StageTimer timer;
    FrameStats stats;
    lights_.update(0.0, camera, stats);
    const LightInput input = lights_.input(camera.position, false, timer);
    // A pixel's ray lies within the picture's extent, its depth at the near plane; its position may
    // be anywhere in the box.
    const auto pad = static_cast<float>(camera.y_extent * (double(across) / down + 3.0));
    const auto depth = static_cast<float>(camera.z_near);
    const ClusterGrid grid = make_cluster_grid({.tiles_x = 1,
                                                .tiles_y = 1,
                                                .slices_per_octave = 1,
                                                .z_first = depth,
                                                .z_last = depth,
                                                .position_pad = pad,
                                                .fine_per_octave = 1},
                                               view.width, view.height);
    const Radiance radiance = lighting_.light({{bytes, planes.layout(), view}, input, grid}, timer);
    const std::vector<float> light = download(gpu_, radiance.planes);
    const std::size_t plane = std::size_t{view.stride} * view.height;
    for (std::size_t i = 0; i < frame.size(); ++i) {
        const std::size_t at = planes.pixel(i);
        const float rgb[3] = {light[at], light[plane + at], light[2 * plane + at]};
        out[frame[i]] = luminance(rgb) * std::numbers::pi;
    }
}

}  // namespace kilolux
