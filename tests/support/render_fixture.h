// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/render/renderer.h"
#include "host/scene/generated/scenes.h"
#include "tests/support/messages.h"

namespace kilolux {

/// The device of this name, open as long as the process lives.
inline std::shared_ptr<const Gpu> opened_device(const std::string& name) {
    static const auto gpu = std::make_shared<const Gpu>(choose_device(name));
    return gpu;
}

/// Settings of a small picture, on one device for all of a program's cases. KILOLUX_TEST_DEVICE
/// chooses it as --device does.
inline RenderSettings small_settings(int width = 96, int height = 54, std::uint64_t lights = 300) {
    RenderSettings settings;
    settings.width = width;
    settings.height = height;
    settings.lights.count = lights;
    const char* device = std::getenv("KILOLUX_TEST_DEVICE");
    settings.device = device != nullptr ? device : "";
    settings.opened = opened_device(settings.device);
    return settings;
}

inline Camera first_camera(const Scene& scene) {
    return scene.cameras.empty() ? frame_box(bounds(scene)) : camera_of(scene.cameras.front());
}

inline Frame render_once(const Scene& scene, const RenderSettings& settings, double time = 0.0) {
    return Renderer(scene, settings).render(first_camera(scene), time);
}

inline bool has_stage(const Frame& frame, std::string_view name) {
    return std::ranges::any_of(frame.stats.stages,
                               [&](const StageTime& stage) { return stage.name == name; });
}

/// Luminance (Rec. 709) of pixel `i` of three channels a pixel.
inline float luminance_of(const std::vector<float>& radiance, std::size_t i) {
    return 0.2126f * radiance[3 * i] + 0.7152f * radiance[3 * i + 1] +
           0.0722f * radiance[3 * i + 2];
}

/// A renderer of these settings is refused with a message that holds `reason`.
inline void expect_refused(const Scene& scene, const RenderSettings& settings,
                           const std::string& reason) {
    const std::string message =
        message_of<UsageError>([&] { const Renderer renderer(scene, settings); });
    EXPECT_TRUE(contains(message, reason)) << message;
}

/// The grid scene with a directional light and a dozen spots.
inline Scene grid_with_every_light() {
    Scene scene = make_generated_scene("grid");
    const Box box = bounds(scene);
    for (int i = 0; i < 12; ++i) {
        SceneLight spot;
        spot.type = LightType::spot;
        const double t = (i + 0.5) / 12.0;
        spot.position = {box.min.x + t * box.size().x, box.max.y + 1.0,
                         box.min.z + (1.0 - t) * box.size().z};
        spot.direction = glm::normalize(glm::dvec3(0.2 - 0.4 * t, -1.0, 0.1));
        spot.intensity = {20.0f, 15.0f + static_cast<float>(i), 10.0f};
        spot.range = 2.0f * static_cast<float>(glm::length(box.size()));
        spot.inner_cone = 0.2f;
        spot.outer_cone = 0.5f;
        scene.lights.push_back(spot);
    }
    SceneLight sun;
    sun.type = LightType::directional;
    sun.direction = glm::normalize(glm::dvec3(0.3, -1.0, -0.5));
    sun.intensity = {0.5f, 0.4f, 0.3f};
    scene.lights.push_back(sun);
    return scene;
}

/// The value at an order statistic, 0.5: the median.
inline double quantile(std::vector<double> values, double q) {
    const auto place = static_cast<std::size_t>(q * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(place),
                     values.end());
    return values[place];
}

/// Differences of the values that are not black in both, relative to the value, or to a hundredth
/// of the mean where it is nearly black.
inline std::vector<double> picture_differences(const Frame& a, const Frame& b) {
    double mean = 0.0;
    for (const float value : a.radiance) mean += value;
    const double floor = 0.01 * mean / static_cast<double>(a.radiance.size());
    std::vector<double> out;
    for (std::size_t i = 0; i < a.radiance.size(); ++i) {
        if (a.radiance[i] == 0.0f && b.radiance[i] == 0.0f) continue;
        out.push_back(std::abs(a.radiance[i] - b.radiance[i]) / (a.radiance[i] + floor));
    }
    return out;
}

/// The sum of the absolute differences over the sum of the first one's values.
inline double mean_difference(const Frame& a, const Frame& b) {
    double difference = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < a.radiance.size(); ++i) {
        difference += std::abs(double{b.radiance[i]} - a.radiance[i]);
        sum += a.radiance[i];
    }
    return difference / sum;
}

/// The renderers whose fragments OpenGL shades round otherwise than `deferred` does.
inline void expect_forward_pictures_near(const Scene& scene, RenderSettings settings,
                                         double bound) {
    const Frame deferred = render_once(scene, settings);
    for (const RendererKind kind : {RendererKind::forward, RendererKind::forward_plus}) {
        settings.renderer = kind;
        EXPECT_LE(mean_difference(deferred, render_once(scene, settings)), bound)
            << static_cast<int>(kind);
    }
}

/// Lists and lanes change no bit of a picture, and some of it is lit.
inline void expect_same_bits_without_lists(const Scene& scene, RenderSettings settings) {
    const Frame listed = render_once(scene, settings);
    EXPECT_GT(*std::ranges::max_element(listed.radiance), 0.01f);
    settings.kernels.lanes = 4;
    settings.renderer = RendererKind::deferred_all;
    EXPECT_EQ(render_once(scene, settings).radiance, listed.radiance);
}

}  // namespace kilolux
