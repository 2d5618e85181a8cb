// SPDX-License-Identifier: Apache-2.0
#include "host/scene/camera_path.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace kilolux {
namespace {

// Change from key to key, a second.
struct Secant {
    double seconds;
    glm::dvec3 position, focal_point;
    double angle;
};

Secant secant(const CameraKey& a, const CameraKey& b) {
    const double s = b.time - a.time;
    return {s, (b.position - a.position) / s, (b.focal_point - a.focal_point) / s,
            (b.angle - a.angle) / s};
}

// Slope at a key between two secants: that of the parabola through the three keys; 0 beside a rest.
glm::dvec3 parabola_slope(const Secant& a, const Secant& b, glm::dvec3 Secant::*value) {
    if (a.*value == glm::dvec3(0.0) || b.*value == glm::dvec3(0.0)) return glm::dvec3(0.0);
    return (b.seconds * (a.*value) + a.seconds * (b.*value)) / (a.seconds + b.seconds);
}

// Weighted harmonic mean of the slopes; 0 where the direction changes (Fritsch and Butland 1984).
double monotone_slope(const Secant& a, const Secant& b) {
    if (a.angle * b.angle <= 0.0) return 0.0;
    const double wa = a.seconds + 2.0 * b.seconds, wb = 2.0 * a.seconds + b.seconds;
    return (wa + wb) / (wa / b.angle + wb / a.angle);
}

template <typename T>
T hermite(double t, double seconds, const T& a, const T& slope_a, const T& b, const T& slope_b) {
    const double t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * seconds * slope_a +
           (3 * t2 - 2 * t3) * b + (t3 - t2) * seconds * slope_b;
}

}  // namespace

CameraPath::CameraPath(std::vector<CameraKey> keys)
    : keys_(std::move(keys)), slopes_(keys_.size(), CameraKey{0, {}, {}, 0}) {
    assert(!keys_.empty());
    const std::size_t last = keys_.size() - 1;
    for (std::size_t i = 0; i <= last && last > 0; ++i) {
        const Secant before = secant(keys_[i == 0 ? 0 : i - 1], keys_[i == 0 ? 1 : i]);
        const Secant after = secant(keys_[i == last ? i - 1 : i], keys_[i == last ? i : i + 1]);
        slopes_[i].position = parabola_slope(before, after, &Secant::position);
        slopes_[i].focal_point = parabola_slope(before, after, &Secant::focal_point);
        slopes_[i].angle = monotone_slope(before, after);
    }
}

CameraKey CameraPath::at(double time) const {
    const auto next = std::upper_bound(keys_.begin(), keys_.end(), time,
                                       [](double t, const CameraKey& key) { return t < key.time; });
    CameraKey out = next == keys_.begin() ? keys_.front() : keys_.back();
    if (next != keys_.begin() && next != keys_.end()) {
        const auto i = static_cast<std::size_t>(next - keys_.begin());
        const CameraKey &a = keys_[i - 1], &b = keys_[i];
        const CameraKey &sa = slopes_[i - 1], &sb = slopes_[i];
        const double s = b.time - a.time, t = (time - a.time) / s;
        out.position = hermite(t, s, a.position, sa.position, b.position, sb.position);
        out.focal_point =
            hermite(t, s, a.focal_point, sa.focal_point, b.focal_point, sb.focal_point);
        out.angle = hermite(t, s, a.angle, sa.angle, b.angle, sb.angle);
    }
    out.time = time;
    return out;
}

Camera turned(Camera camera, const glm::dvec3& centre, double degrees) {
    const double c = std::cos(glm::radians(degrees)), s = std::sin(glm::radians(degrees));
    const glm::dmat3 turn(glm::dvec3(c, 0, -s), glm::dvec3(0, 1, 0), glm::dvec3(s, 0, c));
    camera.position = centre + turn * (camera.position - centre);
    camera.world_from_view = turn * camera.world_from_view;
    return camera;
}

}  // namespace kilolux
