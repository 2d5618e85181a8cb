// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace kilolux {

/// Three doubles: points and directions of the references.
struct Vec3d {
    double x = 0, y = 0, z = 0;
};

inline Vec3d operator+(Vec3d a, Vec3d b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3d operator-(Vec3d a, Vec3d b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3d operator*(Vec3d a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline Vec3d operator*(Vec3d a, Vec3d b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline double dot(Vec3d a, Vec3d b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double length(Vec3d a) { return std::sqrt(dot(a, a)); }
inline Vec3d normalized(Vec3d a) { return a * (1.0 / length(a)); }
inline Vec3d cross(Vec3d a, Vec3d b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Reproducible random numbers.
class Random {
 public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}

    std::uint32_t bits() { return static_cast<std::uint32_t>(engine_()); }
    std::uint32_t below(std::uint32_t end) { return bits() % end; }
    double unit() { return bits() / 4294967296.0; }
    double uniform(double low, double high) { return low + (high - low) * unit(); }
    double log_uniform(double low, double high) { return low * std::pow(high / low, unit()); }
    Vec3d point(double extent) {
        const double x = uniform(-extent, extent);
        const double y = uniform(-extent, extent);
        return {x, y, uniform(-extent, extent)};
    }
    Vec3d direction() {
        Vec3d v = point(1.0);
        while (dot(v, v) > 1.0 || dot(v, v) < 1e-4) v = point(1.0);
        return normalized(v);
    }

 private:
    std::mt19937 engine_;
};

}  // namespace kilolux
