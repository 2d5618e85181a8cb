// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "host/measure/metrics/parallel_rows.h"
#include "host/measure/photometry/measuring_points.h"
#include "host/measure/reference/reference.h"
#include "host/scene/scene.h"

namespace kilolux {

/// What one light adds to a point.
struct LightLux {
    std::size_t light = 0;  // index into Scene::lights
    double lux = 0.0;       // 0: there is no such light
};

/// The illuminance of a point in float64.
struct ExactIlluminance {
    double lux = 0.0;                   // of all lights, each with the window of its range
    double range_loss = 0.0;            // what the windows take away [lx]
    std::array<LightLux, 3> largest{};  // contributors, the largest first
};

/// The illuminance of points by all lights of a scene, in double: brute force, without lists.
///
///     E = sum of Y(intensity) * window * cone^2 * web's share * max(n.l, 0) / max(d, d_min)^2
///       + sum of Y(illuminance) * max(n.l, 0) of directional lights
///       + sum of Y(luminance) * window * (integral of cosine over the solid angle) of lights with
///         a size
///
/// Y is Rec. 709's luminance of linear RGB: a white light of 1 cd has Y = 1. A light without a
/// range has window 1. Nearer than d_min, 1 cm in scenes of 4 m or more, the inverse square stops
/// growing (light_d_min()). Nothing casts shadows, nothing reflects. `scene`: lights that are
/// usable, none follows the camera; outlives this.
class ExactLighting {
 public:
    explicit ExactLighting(const Scene& scene);

    ExactIlluminance at(const MeasuringPoint& point) const;

    /// Cost of at() for one point. The unit is one point light.
    double work() const;

 private:
    ReferenceOptions options_;
    ReferenceLights lights_;                         // world axes
    std::vector<std::size_t> placed_, directional_;  // numbers of their rows
};

/// at() of points of the list `which`, on all cores.
std::vector<ExactIlluminance> exact_illuminance(const ExactLighting& lighting,
                                                std::span<const MeasuringPoint> points,
                                                std::span<const std::size_t> which,
                                                const OnProgress& progress = {});

/// For each point an upper bound of what the ranges of the scene's lights take away there [lx]: of
/// a light whose nearest point is at distance d, intensity / d^2 (with a size at most pi *
/// luminance) times the share that its window takes, at the worst place of the point's group.
/// `order`: order_in_groups() of the points.
std::vector<double> range_loss_bounds(const Scene& scene, std::span<const MeasuringPoint> points,
                                      std::span<const std::uint32_t> order,
                                      const OnProgress& progress = {});

}  // namespace kilolux
