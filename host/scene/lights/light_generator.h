// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/lights/light_region.h"
#include "host/scene/scene.h"

namespace kilolux {

/// How generated point lights are made: `--lights`, `--light-seed`, `--light-radius`,
/// `--light-intensity`, `--light-box`.
struct LightOptions {
    std::uint64_t count = 5000;
    std::uint64_t seed = 1;
    double radius = 0.0;  // range [m]; 0: automatic, from the box and the count
    double intensity =
        0.0;  // brightest colour channel [cd]; 0: automatic, well exposed at any count
    Box box;  // empty: see light_region()
    bool operator==(const LightOptions&) const = default;
};

/// The lights of `options` at `time` [s]. A closed form of (seed, light, time): the same on every
/// machine, order and thread count; every light stays inside its region. Runs on all cores.
std::vector<SceneLight> generate_lights(const LightOptions& options, const Scene& scene,
                                        double time);

/// The properties of a generated light that do not change with time.
struct LightTrack {
    glm::dvec3 phase{0.0};      // along each axis of its part, in turns
    glm::dvec3 speed{0.0};      // [m/s]
    glm::vec3 intensity{0.0f};  // [cd]
    std::uint32_t part = 0;     // of the region, in which it stays
};

/// How far along its path a light is, by axis: turns of its period, and turns a second [1/s]. A
/// period is twice the extent of its part.
struct LightTurns {
    glm::dvec3 at{0.0};  // [0, 1)
    glm::dvec3 rate{0.0};
};

/// Single lights of `options` at a time [s], as generate_lights() makes them.
class LightGenerator {
 public:
    /// Throws Error when the box, the radius, the intensity or the time is not finite.
    LightGenerator(const LightOptions& options, const Scene& scene, double time);
    SceneLight operator[](std::uint64_t light) const { return at(track(light)); }

    /// A light in two steps: the first takes longer, and its result is the same at any time.
    LightTrack track(std::uint64_t light) const;
    SceneLight at(const LightTrack& track) const;
    LightTurns turns(const LightTrack& track) const;

    /// The boxes that lights stay in: LightTrack::part.
    const std::vector<Box>& parts() const { return parts_; }

    /// Range of every light [m].
    float range() const { return static_cast<float>(options_.radius); }

    /// Whether the lights of another time have the same tracks.
    bool has_paths_of(const LightGenerator& other) const {
        return options_ == other.options_ && parts_ == other.parts_;
    }

 private:
    LightOptions options_;    // nothing automatic but the box
    std::vector<Box> parts_;  // of the region: one, or six about a hole
    double time_;
};

/// Range [m], intensity [cd] and region that `options` stands for when they are automatic.
struct LightScale {
    double radius = 0.0;
    double intensity = 0.0;
    LightRegion region;
};
LightScale automatic_light_scale(const LightOptions& options, const Scene& scene);

}  // namespace kilolux
