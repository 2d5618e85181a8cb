// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <ostream>
#include <random>

#include "host/measure/reference/area/area_light.h"
#include "kernels/shared/area/round_light.h"

namespace kilolux {

inline const glm::dvec3 kUp(0.0, 0.0, 1.0);

inline FV3 float3_of(const glm::dvec3& v) {
    return fv3(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
}

inline glm::dvec3 rounded(const glm::dvec3& v) { return glm::dvec3(glm::vec3(v)); }

/// The shape that float32 can hold, shining to the origin.
inline AreaShape stored(AreaShape s) {
    s.center = rounded(s.center);
    s.half_x = rounded(s.half_x);
    s.half_y = rounded(s.half_y);
    s.radius = static_cast<float>(s.radius);
    if (glm::dot(s.center, glm::cross(s.half_x, s.half_y)) > 0.0) s.half_y = -s.half_y;
    return s;
}

// As kernels integrate spheres.
inline FV sphere_irradiance(FV3 center, FV radius) {
    const FlatLight disk = sphere_disk(center, radius);
    return facing_disk_irradiance(disk.center, disk.half_x);
}

/// The shared text's value.
inline double shared_cosine(const AreaShape& s) {
    const FV3 center = float3_of(s.center), x = float3_of(s.half_x), y = float3_of(s.half_y);
    switch (s.kind) {
        case AreaKind::rectangle:
            return parallelogram_irradiance(center, x, y, false);
        case AreaKind::triangle:
            return triangle_irradiance(center, x, y, false);
        case AreaKind::disk:
            return disk_irradiance(center, x, y, false);
        case AreaKind::sphere:
            break;
    }
    return sphere_irradiance(center, static_cast<float>(s.radius));
}

inline std::ostream& operator<<(std::ostream& out, const AreaShape& s) {
    const auto vector = [&](const char* name, const glm::dvec3& v) {
        out << ' ' << name << ' ' << v.x << ',' << v.y << ',' << v.z;
    };
    out.precision(9);
    out << "kind " << static_cast<int>(s.kind);
    vector("center", s.center);
    vector("x", s.half_x);
    vector("y", s.half_y);
    return out << " radius " << s.radius;
}

/// Random numbers of the cases.
class AreaRandom {
 public:
    explicit AreaRandom(unsigned seed) : generator_(seed) {}
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(generator_);
    }
    double log_uniform(double low, double high) {
        return std::exp(uniform(std::log(low), std::log(high)));
    }
    glm::dvec3 direction() {
        const double z = uniform(-1.0, 1.0), f = uniform(0.0, 2.0 * std::numbers::pi);
        const double s = std::sqrt(1.0 - z * z);
        return {s * std::cos(f), s * std::sin(f), z};
    }

 private:
    std::mt19937 generator_;
};

/// Half of the shape's extent along z.
inline double half_height(const AreaShape& s) {
    const double x = std::abs(s.half_x.z), y = std::abs(s.half_y.z);
    if (s.kind == AreaKind::sphere) return s.radius;
    if (s.kind == AreaKind::disk) return std::hypot(x, y);
    return s.kind == AreaKind::rectangle ? x + y : (x + y) / 3.0;
}

/// A shape at `distance` in sizes; every second one beyond 3 sizes touches the horizon. Nearer than
/// 0.3, the distance is that of some point of a flat shape, or of a sphere's surface.
inline AreaShape random_shape(AreaKind kind, double distance, double aspect, AreaRandom& random) {
    AreaShape s;
    s.kind = kind;
    const double size = random.log_uniform(1e-3, 1e2);
    const glm::dvec3 a = random.direction();
    const glm::dvec3 b = glm::normalize(glm::cross(a, random.direction()));
    s.half_x = a * size;
    s.half_y =
        (b + a * (random.uniform(0, 1) < 0.3 ? random.uniform(-0.7, 0.7) : 0.0)) * (aspect * size);
    s.center = random.direction() * (distance * size);
    if (kind == AreaKind::sphere) {
        s.half_x = s.half_y = glm::dvec3(0.0);
        s.radius = size;
        s.center = random.direction() * (size * (1.0 + distance));
    } else if (distance < 0.3) {
        const double reach = kind == AreaKind::triangle ? 0.3 : 0.9;
        s.center = glm::cross(a, b) * (distance * size) + s.half_x * random.uniform(-reach, reach) +
                   s.half_y * random.uniform(-reach, reach);
    }
    if (distance > 3.0 && random.uniform(0, 1) < 0.5)
        s.center.z = half_height(s) * random.uniform(-1.0, 1.0);
    return stored(s);
}

/// The irradiance of the shape if both it and the surface faced each other, at most pi, or the
/// length of the vector irradiance where that is larger.
inline double faced_cosine(const AreaShape& s) {
    const double shares[] = {4.0, std::numbers::pi, 0.0, 0.5};
    const double area =
        s.kind == AreaKind::sphere
            ? std::numbers::pi * s.radius * s.radius
            : shares[static_cast<int>(s.kind)] * glm::length(glm::cross(s.half_x, s.half_y));
    const double flat = std::min(std::numbers::pi, area / glm::dot(s.center, s.center));
    const auto along = [](const glm::dvec3& to_light) { return to_light; };
    return std::max(flat, glm::length(integrate_area(s, along, 1e-8).value));
}

/// How much the value changes when the inputs change by a unit in the last place.
inline double input_error(const AreaShape& s, double value, AreaRandom& random) {
    constexpr double kUnit = 1.2e-7;
    double change = 0.0;
    for (int i = 0; i < 6; ++i) {
        AreaShape moved = s;
        moved.center += random.direction() * glm::length(s.center) * kUnit;
        moved.half_x += random.direction() * glm::length(s.half_x) * kUnit;
        moved.half_y += random.direction() * glm::length(s.half_y) * kUnit;
        moved.radius *= 1.0 + kUnit * random.uniform(-1.0, 1.0);
        change = std::max(change, std::abs(reference_cosine(moved, kUp).value - value));
    }
    return change;
}

/// The shared text's error beyond that of inputs rounded to float32, relative to faced_cosine().
inline double cosine_error(const AreaShape& s, AreaRandom& random) {
    const double want = reference_cosine(s, kUp).value;
    const double wrong = std::abs(shared_cosine(s) - want), faced = faced_cosine(s);
    if (wrong <= 2e-6 * faced) return faced > 0.0 ? wrong / faced : 0.0;
    return std::max(0.0, wrong - input_error(s, want, random)) / faced;
}

}  // namespace kilolux
