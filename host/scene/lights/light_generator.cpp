// SPDX-License-Identifier: Apache-2.0
// Lights are computed by integer operations and the exactly rounded ones of IEEE 754 (+ - * / sqrt,
// floor, conversions), never by libm's transcendental functions: every machine makes the same bits.
#include "host/scene/lights/light_generator.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/base/error.h"
#include "host/base/light_cells.h"
#include "host/base/point_pair.h"
#include "host/base/system/parallel.h"
#include "host/scene/lights/light_kinds.h"

namespace kilolux {
namespace {

constexpr double kCoverage = 10.0;          // mean number of lights that reach a point of the box
constexpr double kShellCoverage = 40.0;     // the same of a shell
constexpr double kExposedRadiance = 0.257;  // of a surface of albedo 0.5: middle of a tone curve
constexpr double kExposedAlbedo = 0.5;
// Of with_colour() over all hues, measured; a test checks it.
constexpr double kMeanLuminance = 0.633;
constexpr double kMaxSpeed = 1.2;              // [m/s] along one axis
constexpr double kMinCrossing = 8.0;           // [s] that a light takes at least across the box
constexpr std::uint64_t kLightsAtOnce = 4096;  // fewer are not worth a task

constexpr double kGapOfRange = 0.25;  // between an object's box and the lights around it

LightRegion region_of(const LightOptions& options, const Scene& scene, double gap) {
    if (!options.box.empty()) return {options.box, {}};
    return light_region(scene, gap);
}

double volume(const Box& box) { return box.size().x * box.size().y * box.size().z; }

// The box, or six boxes that fill it around the hole: below and above it, then beside it.
std::vector<Box> parts_of(const LightRegion& region) {
    if (region.hole.empty()) return {region.outer};
    std::vector<Box> parts;
    Box rest = region.outer;
    for (const int axis : {1, 0, 2}) {
        Box low = rest, high = rest;
        low.max[axis] = region.hole.min[axis];
        high.min[axis] = region.hole.max[axis];
        parts.insert(parts.end(), {low, high});
        rest.min[axis] = region.hole.min[axis];
        rest.max[axis] = region.hole.max[axis];
    }
    return parts;
}

void check(const LightOptions& options, const Box& box, double time) {
    const auto require = [](bool holds, const char* what, double value) {
        if (!holds) throw Error(fmt::format("lights: {}, not {}", what, value));
    };
    const bool box_is_finite = glm::all(glm::lessThan(glm::abs(box.min), glm::dvec3(1e300))) &&
                               glm::all(glm::lessThan(glm::abs(box.max), glm::dvec3(1e300)));
    require(box_is_finite, "the box must be finite", glm::length(box.size()));
    for (int axis = 0; axis < 3; ++axis) {
        require(box.size()[axis] >= 0.0, "the box must have max >= min", box.size()[axis]);
    }
    require(std::isfinite(time), "time must be finite", time);
    require(std::isfinite(options.radius) && options.radius >= 0.0, "the radius must be >= 0",
            options.radius);
    require(std::isfinite(options.intensity) && options.intensity >= 0.0,
            "the intensity must be >= 0", options.intensity);
    require(std::isfinite(options.size) && options.size >= 0.0, "the size must be >= 0",
            options.size);
}

// Newton's method from a power of two; std::cbrt's last bit depends on the library.
double cube_root(double x) {
    if (!(x > 0.0)) return 0.0;
    double root = std::ldexp(1.0, std::ilogb(x) / 3);
    for (int i = 0; i < 12; ++i) root = (2.0 * root + x / (root * root)) / 3.0;
    return root;
}

// Range [m] with which `count` lights in a box of these extents cover a point kCoverage times on
// average. In a box flatter than the range the spheres act as discs, in a thinner one as intervals;
// the largest of the three results applies.
double covering_radius(glm::dvec3 size, double count) {
    double extent[3] = {size.x, size.y, size.z};
    std::sort(extent, extent + 3);
    const double share = kCoverage / count;
    const double ball =
        cube_root(share * extent[0] * extent[1] * extent[2] * 3.0 / (4.0 * std::numbers::pi));
    const double disc = std::sqrt(share * extent[1] * extent[2] / std::numbers::pi);
    const double interval = share * extent[2] / 2.0;
    const double diagonal = std::sqrt(glm::dot(size, size));
    return diagonal > 0.0 ? std::min({std::max({ball, disc, interval}), diagonal}) : 1.0;
}

// The same in a shell, which is never thin. Most of a sphere about a point of its object lies
// outside of it, and a surface may be well inside the object's box.
double covering_radius(const LightRegion& shell, double count) {
    const double space = volume(shell.outer) - volume(shell.hole);
    const glm::dvec3 size = shell.outer.size();
    return std::min(cube_root(kShellCoverage / count * space * 3.0 / (4.0 * std::numbers::pi)),
                    std::sqrt(glm::dot(size, size)));
}

double intensity_of(double volume, double count, double reach) {
    return kExposedRadiance * volume / (kExposedAlbedo * count * reach) / kMeanLuminance;
}

// Brightest channel [cd] that exposes well. A surface in a cloud of n lights per m^3 receives
//   E = n I int_hemisphere cos(w) dw int_0^R window(d) dd = n I pi 0.8 R
// (the inverse square cancels the volume element). A box smaller than the range has only lights up
// to its walls, whose mean distance is 4 V / S; the two limits join harmonically.
double exposing_intensity(glm::dvec3 size, double count, double radius) {
    const glm::dvec3 s = glm::max(size, glm::dvec3(radius * 0.5));
    const double volume = s.x * s.y * s.z;
    const double mean_chord = 2.0 * volume / (s.x * s.y + s.y * s.z + s.z * s.x);
    const double reach = 1.0 / (1.0 / (0.8 * radius) + 1.0 / mean_chord);
    return intensity_of(volume, count, reach);
}

// The same for a surface that a shell of lights is around: they begin at a distance, and the mean
// path through a layer, by the cosine, is twice its thickness.
double exposing_intensity(const LightRegion& shell, const glm::dvec3& inside, double count,
                          double radius) {
    const double gap = 0.5 * (shell.hole.size().x - inside.x);
    const double thickness = 0.5 * (shell.outer.size().x - shell.hole.size().x);
    const double reach = 1.0 / (1.0 / (0.8 * radius - gap) + 0.5 / thickness);
    return intensity_of(volume(shell.outer) - volume(shell.hole), count, reach);
}

// A share in [0, 1] in units of 2^-64; 1 is one unit less.
ulong fixed_point(double share) {
    const double units = share * 0x1p64;
    return units < 0x1p64 ? static_cast<ulong>(units) : ~ulong{0};
}

// Twice the turns a second of the fastest light along an axis of this extent.
ulong twice_max_turns(double extent) {
    if (!(extent > 0.0)) return 0;
    return fixed_point(std::min(kMaxSpeed, extent / kMinCrossing) / extent);
}

// A box that lights of a range drift in; `share` of all lights are in it or in an earlier box.
DriftBox drift_box(const Box& box, double range, double share) {
    const glm::dvec3 extents = box.size();
    const PointPair corner = point_pair(box.min.x, box.min.y, box.min.z);
    const PointPair size = point_pair(extents.x, extents.y, extents.z);
    const ulong x = twice_max_turns(extents.x), y = twice_max_turns(extents.y),
                z = twice_max_turns(extents.z), w = fixed_point(share);
    DriftBox out{corner.high,
                 corner.low,
                 size.high,
                 size.low,
                 {high_half(x), high_half(y), high_half(z), high_half(w)},
                 {low_half(x), low_half(y), low_half(z), low_half(w)}};
    out.min.w = static_cast<float>(range);
    out.extent.w = static_cast<float>(1.0 / light_cell_edge(out.min.w));
    return out;
}

// Parts get lights in proportion to their volumes.
LightSwarm make_swarm(const LightOptions& options, const std::vector<Box>& parts) {
    LightSwarm out{high_half(options.seed),
                   low_half(options.seed),
                   static_cast<float>(options.intensity),
                   static_cast<uint>(parts.size()),
                   {options.gain.x, options.gain.y, options.gain.z, 0.0f},
                   {}};
    double all = 0.0, sum = 0.0;
    for (const Box& part : parts) all += volume(part);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        sum += volume(parts[i]);
        const double share = sum / all;  // of an empty or endless volume: not a number
        out.boxes[i] = drift_box(parts[i], options.radius, share >= 0.0 ? share : 0.0);
    }
    return out;
}

}  // namespace

LightScale automatic_light_scale(const LightOptions& options, const Scene& scene) {
    LightScale scale{options.radius, options.intensity, region_of(options, scene, 0.0)};
    const LightRegion at_surface = scale.region;
    check(options, at_surface.outer, 0.0);
    const double count = static_cast<double>(std::max<std::uint64_t>(options.count, 1));
    const glm::dvec3 size = at_surface.outer.size();
    const bool around = !at_surface.hole.empty();
    if (!(scale.radius > 0.0)) {
        scale.radius = around ? covering_radius(at_surface, count) : covering_radius(size, count);
    }
    if (around) scale.region = region_of(options, scene, kGapOfRange * scale.radius);
    if (!(scale.intensity > 0.0)) {
        scale.intensity =
            around ? exposing_intensity(scale.region, at_surface.hole.size(), count, scale.radius)
                   : exposing_intensity(size, count, scale.radius);
    }
    return scale;
}

DriftTime drift_time(double time) {
    double whole = std::floor(time), rest = time - whole;
    if (rest == 1.0) whole += 1.0, rest = 0.0;  // rounded
    const double wrapped = std::fmod(std::abs(whole), 0x1p64);
    const ulong magnitude = static_cast<ulong>(wrapped);
    const ulong seconds = whole < 0.0 ? 0 - magnitude : magnitude, part = fixed_point(rest);
    return {high_half(seconds), low_half(seconds), high_half(part), low_half(part)};
}

LightGenerator::LightGenerator(const LightOptions& options, const Scene& scene, double time)
    : options_(options) {
    const LightScale scale = automatic_light_scale(options_, scene);
    check(options, scale.region.outer, time);
    options_.radius = scale.radius;
    options_.intensity = scale.intensity;
    parts_ = parts_of(scale.region);
    swarm_ = make_swarm(options_, parts_);
    time_ = drift_time(time);
}

SceneLight LightGenerator::operator[](std::uint64_t light) const {
    const LightDrift drift = swarm_light(&swarm_, light);
    const Box& box = parts_[drift.high.w];
    const std::array<ulong, 3> shares{DRIFT_SHARE(drift, x, time_), DRIFT_SHARE(drift, y, time_),
                                      DRIFT_SHARE(drift, z, time_)};
    SceneLight out;
    for (int axis = 0; axis < 3; ++axis) {
        const double share = static_cast<double>(shares[static_cast<std::size_t>(axis)]) * 0x1p-63;
        const double at = box.min[axis] + share * (box.max[axis] - box.min[axis]);
        out.position[axis] = std::clamp(at, box.min[axis], box.max[axis]);
    }
    const float4 intensity = drift_intensity(&swarm_, drift);
    out.intensity = {intensity.x, intensity.y, intensity.z};
    out.range = static_cast<float>(options_.radius);
    out.radius = static_cast<float>(options_.size);
    if (out.radius > 0.0f) out.type = LightType::sphere;
    return out;
}

bool has_area_lights(std::span<const SceneLight> lights, const LightOptions& options) {
    return (options.count > 0 && options.size > 0.0) || std::ranges::any_of(lights, &is_area_light);
}

std::vector<SceneLight> generate_lights(const LightOptions& options, const Scene& scene,
                                        double time) {
    const LightGenerator generator(options, scene, time);
    std::vector<SceneLight> lights(options.count);
    const auto fill = [&](std::uint64_t i) { lights[i] = generator[i]; };
    parallel_for(std::uint64_t{0}, options.count, fill, kLightsAtOnce);
    return lights;
}

}  // namespace kilolux
