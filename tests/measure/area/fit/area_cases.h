// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "host/measure/reference/area/area_light.h"
#include "tests/measure/area/fit/ggx_lobe.h"

namespace kilolux {

using DirectionFunction = std::function<glm::dvec2(const glm::dvec3& to_light)>;

// Integrals over the solid angle of a light above the horizon z = 0, by Gauss's rule of 5 x 5
// points in cells that are small beside `width` and their angle to `peak`: integrate_area(), which
// does not know where a lobe is, would miss one of a thousandth of the light.
class PeakedIntegral {
 public:
    PeakedIntegral(AreaShape shape, glm::dvec3 peak, double width)
        : shape_(std::move(shape)), peak_(peak), width_(width) {
        if (shape_.kind == AreaKind::sphere) become_disk();
        normal_ = glm::cross(shape_.half_x, shape_.half_y);
    }

    glm::dvec2 operator()(const DirectionFunction& f) const { return cell(f, 0.5, 0.5, 0.5, 0); }

 private:
    struct Point {
        glm::dvec3 at;
        double area;  // by du dv, over |half_x x half_y|
    };

    // The disk of the sphere's solid angle.
    void become_disk() {
        const double d2 = glm::dot(shape_.center, shape_.center);
        const double share = 1.0 - shape_.radius * shape_.radius / d2;
        const glm::dvec3 axis = shape_.center / std::sqrt(d2);
        const glm::dvec3 other = std::abs(axis.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        shape_.half_x = glm::normalize(glm::cross(axis, other)) * shape_.radius * std::sqrt(share);
        shape_.half_y = glm::cross(axis, shape_.half_x);
        shape_.center *= share;
        shape_.kind = AreaKind::disk;
    }

    // u, v: from 0 to 1.
    Point point(double u, double v) const {
        const glm::dvec3 x = shape_.half_x, y = shape_.half_y;
        if (shape_.kind == AreaKind::rectangle) {
            return {shape_.center + (2 * u - 1) * x + (2 * v - 1) * y, 4.0};
        }
        if (shape_.kind == AreaKind::triangle) {
            const glm::dvec3 corner = shape_.center - (x + y) / 3.0;
            return {corner + u * ((1 - v) * x + v * y), u};
        }
        const double around = 2.0 * std::numbers::pi * v;
        return {shape_.center + u * (std::cos(around) * x + std::sin(around) * y),
                2.0 * std::numbers::pi * u};
    }

    // The cell of the centre (u, v) and half the side `half`.
    glm::dvec2 cell(const DirectionFunction& f, double u, double v, double half, int depth) const {
        const glm::dvec3 middle = point(u, v).at;
        double reach = 0.0, low = middle.z, high = middle.z;
        for (int i = 0; i < 9; ++i) {
            const glm::dvec3 at = point(u + half * (i / 3 - 1), v + half * (i % 3 - 1)).at;
            reach = std::max(reach, glm::length(at - middle));
            low = std::min(low, at.z);
            high = std::max(high, at.z);
        }
        if (high <= 0.0) return glm::dvec2(0.0);
        const double distance = glm::length(middle), size = reach / distance;
        const double scale = std::max(width_, glm::length(middle / distance - peak_) - size);
        const bool cut = low < 0.0;
        const bool large = size > 0.5 * std::min(scale, 1.0) && depth < 24;
        if (large || (cut && depth < 9 && size > 0.02 * std::min(scale, 1.0))) {
            glm::dvec2 sum(0.0);
            for (int i = 0; i < 4; ++i) {
                const double du = half * (i / 2 - 0.5), dv = half * (i % 2 - 0.5);
                sum += cell(f, u + du, v + dv, 0.5 * half, depth + 1);
            }
            return sum;
        }
        return gauss(f, u, v, half);
    }

    glm::dvec2 gauss(const DirectionFunction& f, double u, double v, double half) const {
        constexpr double kAt[] = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                  0.9061798459386640};
        constexpr double kWeight[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                      0.4786286704993665, 0.2369268850561891};
        glm::dvec2 sum(0.0);
        for (int i = 0; i < 5; ++i) {
            for (int j = 0; j < 5; ++j) {
                const Point p = point(u + half * kAt[i], v + half * kAt[j]);
                if (p.at.z <= 0.0) continue;
                const double d2 = glm::dot(p.at, p.at), d = std::sqrt(d2);
                const double angle = std::abs(glm::dot(normal_, p.at)) * p.area / (d2 * d);
                sum += f(p.at / d) * (angle * kWeight[i] * kWeight[j] * half * half);
            }
        }
        return sum;
    }

    AreaShape shape_;
    glm::dvec3 peak_;
    double width_;
    glm::dvec3 normal_{0.0};
};

/// D V n.l of a lobe over a light, and that times Schlick's (1 - v.h)^5, in double.
inline glm::dvec2 lobe_integral(const RoundLobe& lobe, const AreaShape& shape) {
    const glm::dvec3 eye = lobe.to_eye(), mirror(-eye.x, 0.0, eye.z);
    const double width = lobe.alpha * std::max(lobe.n_dot_v, lobe.alpha);
    return PeakedIntegral(shape, mirror, width)([&](const glm::dvec3& l) {
        const double value = lobe.value(l);
        return glm::dvec2(value, value * lobe.schlick(l));
    });
}

/// A light at distance 1 about the direction `middle`, `size` wide, turned up to 50 degrees away
/// from the point, of a random outline; facing the point.
inline AreaShape random_light(AreaKind kind, const glm::dvec3& middle, double size,
                              std::mt19937& random) {
    std::uniform_real_distribution<double> some(-0.5, 0.5);
    const auto vector = [&] { return glm::dvec3(some(random), some(random), some(random)); };
    glm::dvec3 normal = glm::normalize(-middle + 1.5 * vector());
    if (glm::dot(normal, middle) > 0.0) normal = -normal;
    const glm::dvec3 x = glm::normalize(glm::cross(normal, vector()));
    const double stretch = std::exp(2.0 * some(random));
    AreaShape shape;
    shape.kind = kind;
    shape.center = middle;
    const double scale = kind == AreaKind::triangle ? 1.5 : 0.5;
    shape.half_x = x * (scale * size * stretch);
    shape.half_y = glm::cross(normal, x) * (scale * size / stretch);
    if (kind == AreaKind::triangle) shape.half_y += some(random) * shape.half_x;
    shape.radius = std::min(0.5 * size, 0.95);
    return shape;
}

/// Directions around the mirror direction of a lobe: a sixth at it, a sixth anywhere within 1.5,
/// the others within three times the width of lobe and light.
inline glm::dvec3 random_direction(const RoundLobe& lobe, double size, int number,
                                   std::mt19937& random) {
    std::uniform_real_distribution<double> some(0.0, 1.0);
    const glm::dvec3 eye = lobe.to_eye(), mirror(-eye.x, 0.0, eye.z);
    while (true) {
        double away = 3.0 * (lobe.alpha + size) * some(random);
        if (number % 6 == 0) away = 0.0;
        if (number % 6 == 1) away = 1.5 * some(random);
        const double around = 2.0 * std::numbers::pi * some(random);
        const glm::dvec3 across(eye.z * std::cos(around), std::sin(around),
                                eye.x * std::cos(around));
        const glm::dvec3 direction = glm::normalize(mirror + away * across);
        if (direction.z > 0.02 || away == 0.0) return direction;
    }
}

}  // namespace kilolux
