// SPDX-License-Identifier: Apache-2.0
#include "host/measure/photometry/exact_illuminance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/measure/metrics/compensated_sum.h"
#include "host/scene/lights/environment.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_region.h"
#include "host/scene/lights/light_shape.h"

namespace kilolux {
namespace {

// The illuminance of a light with a place, without the window of its range [lx].
double unbounded_lux(const ReferenceLight& light, const MeasuringPoint& point,
                     const ReferenceOptions& unbounded) {
    const double candela = luminance(light.intensity);
    if (light.shape) {
        AreaShape shape = *light.shape;
        shape.center = light.position - point.position;
        return candela * light.inverse_area * reference_cosine(shape, point.normal).value;
    }
    const Incidence in = incidence(light, point.position, unbounded);
    return candela * in.attenuation * std::max(glm::dot(point.normal, in.to_light), 0.0);
}

void keep_largest(std::array<LightLux, 3>& largest, LightLux next) {
    for (LightLux& kept : largest) {
        if (next.lux > kept.lux) std::swap(next, kept);
    }
}

// The least and the greatest distance of a box's points from a point.
struct Distances {
    double least = 0.0, greatest = 0.0;
};

Distances distances_to(const Box& box, const glm::dvec3& p) {
    const glm::dvec3 outside = glm::max(glm::max(box.min - p, p - box.max), glm::dvec3(0.0));
    const glm::dvec3 across = glm::max(glm::abs(box.min - p), glm::abs(box.max - p));
    return {glm::length(outside), glm::length(across)};
}

// A light with a size and a range.
struct BoundedLight {
    glm::dvec3 position{0.0};
    double candela = 0.0, range = 0.0;
    double radius = 0.0;  // of its size [m]
    double most = 0.0;    // of its illuminance [lx]
};

// At most what the range takes away at a distance from the light's middle. Points of the light may
// be nearer by its radius.
double loss_at(const BoundedLight& light, double distance) {
    const double quotient = distance / light.range;
    const double share = std::min(quotient * quotient * quotient * quotient, 1.0);
    if (share == 0.0) return 0.0;
    const double nearest = std::max(distance - light.radius, 0.0);
    return share * std::min(light.candela / (nearest * nearest), light.most);
}

// The most of loss_at() at these distances x. With r the radius it grows while `most` limits it,
// falls up to 2 r as x^4 / (x - r)^2 does, grows up to the range, and falls beyond.
double largest_loss(const BoundedLight& light, const Distances& d) {
    const double limited = light.radius + std::sqrt(light.candela / light.most);
    return std::max(loss_at(light, std::clamp(limited, d.least, d.greatest)),
                    loss_at(light, std::clamp(light.range, d.least, d.greatest)));
}

// Lights without a size that have a range, a number each in every array, so that compilers make
// vectors of them.
class BoundedPoints {
 public:
    void add(const SceneLight& light) {
        position_[0].push_back(light.position.x);
        position_[1].push_back(light.position.y);
        position_[2].push_back(light.position.z);
        candela_.push_back(luminance(glm::dvec3(light.intensity)));
        range2_.push_back(double{light.range} * light.range);
    }

    // The sum of what their ranges take away at most at the box's points. With x the square of the
    // distance it is candela * min(x / range^4, 1 / x): it grows up to the range and falls beyond.
    double loss(const Box& box) const {
        constexpr std::size_t kPart = 256;
        std::array<double, kPart> losses;
        double sum = 0.0;
        for (std::size_t first = 0; first < candela_.size(); first += kPart) {
            const std::size_t count = std::min(kPart, candela_.size() - first);
            for (std::size_t i = 0; i < count; ++i) losses[i] = loss(box, first + i);
            for (std::size_t i = 0; i < count; ++i) sum += losses[i];
        }
        return sum;
    }

 private:
    double loss(const Box& box, std::size_t i) const {
        double least2 = 0.0, greatest2 = 0.0;
        for (glm::length_t c = 0; c < 3; ++c) {
            const double at = position_[static_cast<std::size_t>(c)][i];
            const double below = box.min[c] - at, above = at - box.max[c];
            const double outside = std::max(std::max(below, above), 0.0);
            const double across = std::max(std::abs(below), std::abs(above));
            least2 += outside * outside;
            greatest2 += across * across;
        }
        const double range2 = range2_[i];
        const double x = std::min(std::max(range2, least2), greatest2);
        return x > range2 ? candela_[i] / x : candela_[i] * x / (range2 * range2);
    }

    std::array<std::vector<double>, 3> position_;
    std::vector<double> candela_, range2_;
};

struct BoundedLights {
    std::vector<BoundedLight> sized;
    BoundedPoints points;
};

BoundedLights bounded_lights(const Scene& scene) {
    BoundedLights out;
    for (const SceneLight& light : scene.lights) {
        if (!kind_of(light).is_placed || !(light.range > 0.0f)) continue;
        if (!is_area_light(light)) {
            out.points.add(light);
            continue;
        }
        BoundedLight& next = out.sized.emplace_back();
        next.position = light.position;
        next.candela = luminance(glm::dvec3(light.intensity));
        next.range = light.range;
        next.radius = bounding_radius(light);
        next.most = std::numbers::pi * next.candela / seen_area(light);
    }
    return out;
}

}  // namespace

ExactLighting::ExactLighting(const Scene& scene)
    : lights_(reference_lights(scene.lights, Camera(), &scene)) {
    options_.light_d_min = light_d_min(scene);
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        (kind_of(scene.lights[i]).is_placed ? placed_ : directional_).push_back(i);
    }
}

ExactIlluminance ExactLighting::at(const MeasuringPoint& point) const {
    ExactIlluminance out;
    CompensatedSum lux, range_loss;
    ReferenceOptions unbounded = options_;
    unbounded.windowed = false;
    const auto add = [&](std::size_t light, double whole, double window) {
        if (whole == 0.0) return;
        lux.add(whole * window);
        range_loss.add(whole * (1.0 - window));
        keep_largest(out.largest, {light, whole * window});
    };
    for (std::size_t i = 0; i < lights_.directional.size(); ++i) {
        const ReferenceDirectionalLight& light = lights_.directional[i];
        const double cosine = std::max(glm::dot(point.normal, light.to_light), 0.0);
        add(directional_[i], luminance(light.illuminance) * cosine, 1.0);
    }
    for (std::size_t i = 0; i < lights_.lights.size(); ++i) {
        const ReferenceLight& light = lights_.lights[i];
        const double window = window_at(light, point.position, options_);
        add(placed_[i], unbounded_lux(light, point, unbounded), window);
    }
    out.lux = lux.value();
    out.range_loss = range_loss.value();
    return out;
}

double ExactLighting::work() const {
    constexpr double kAreaLight = 100.0;  // about; of the quadrature
    double out = 1.0 + static_cast<double>(lights_.directional.size());
    for (const ReferenceLight& light : lights_.lights) out += light.shape ? kAreaLight : 1.0;
    return out;
}

std::vector<ExactIlluminance> exact_illuminance(const ExactLighting& lighting,
                                                std::span<const MeasuringPoint> points,
                                                std::span<const std::size_t> which,
                                                const OnProgress& progress) {
    constexpr std::size_t kChunk = 64;  // points of a task
    std::vector<ExactIlluminance> out(which.size());
    const auto chunks = static_cast<int>((which.size() + kChunk - 1) / kChunk);
    parallel_rows(
        chunks,
        [&](int chunk) {
            const std::size_t first = static_cast<std::size_t>(chunk) * kChunk;
            for (std::size_t i = first; i < std::min(first + kChunk, which.size()); ++i) {
                out[i] = lighting.at(points[which[i]]);
            }
        },
        progress);
    return out;
}

std::vector<double> range_loss_bounds(const Scene& scene, std::span<const MeasuringPoint> points,
                                      std::span<const std::uint32_t> order,
                                      const OnProgress& progress) {
    std::vector<double> out(points.size(), 0.0);
    const BoundedLights lights = bounded_lights(scene);
    const auto groups = static_cast<int>((order.size() + kGroupPoints - 1) / kGroupPoints);
    const auto bound_group = [&](int group) {
        const std::size_t first = static_cast<std::size_t>(group) * kGroupPoints;
        const auto mine = order.subspan(first, std::min(kGroupPoints, order.size() - first));
        Box box;
        for (const std::uint32_t i : mine) box.add(points[i].position);
        double sum = lights.points.loss(box);
        for (const BoundedLight& light : lights.sized) {
            sum += largest_loss(light, distances_to(box, light.position));
        }
        for (const std::uint32_t i : mine) out[i] = sum;
    };
    parallel_rows(groups, bound_group, progress);
    return out;
}

}  // namespace kilolux
