// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/scene/lights/light_region.h"
#include "host/scene/scene.h"
#include "kernels/shared/lights/light_drift.h"

namespace kilolux {

/// How generated point lights are made: `--lights`, `--light-seed`, `--light-radius`,
/// `--light-intensity`, `--light-size`, `--light-box`.
struct LightOptions {
    std::uint64_t count = 5000;
    std::uint64_t seed = 1;
    double radius = 0.0;  // range [m]; 0: automatic, from the box and the count
    double intensity =
        0.0;               // brightest colour channel [cd]; 0: automatic, well exposed at any count
    double size = 0.0;     // radius of spheres [m]; 0: points
    Box box;               // empty: see light_region()
    glm::vec3 gain{1.0f};  // factors of the intensity: see mixed_generated()
    bool operator==(const LightOptions&) const = default;
};

/// Whether one of a scene's lights or of those that `options` generate has a size.
bool has_area_lights(std::span<const SceneLight> lights, const LightOptions& options);

/// The lights of `options` at `time` [s]. A closed form of (seed, light, time): the same on every
/// machine, order and thread count; every light stays inside its region. Runs on all cores.
std::vector<SceneLight> generate_lights(const LightOptions& options, const Scene& scene,
                                        double time);

/// A time [s] as the device takes it.
DriftTime drift_time(double time);

/// Single lights of `options` at a time [s], as generate_lights() makes them.
class LightGenerator {
 public:
    /// Throws Error when the box, the radius, the intensity or the time is not finite.
    LightGenerator(const LightOptions& options, const Scene& scene, double time);
    SceneLight operator[](std::uint64_t light) const;

    /// What makes them, for the device.
    const LightSwarm& swarm() const { return swarm_; }

    /// The boxes that lights stay in: LightDrift::high.w.
    const std::vector<Box>& parts() const { return parts_; }

    /// Whether both make the same lights, at whatever time, but for their gain.
    bool has_paths_of(const LightGenerator& other) const {
        LightOptions options = options_;
        options.gain = other.options_.gain;
        return options == other.options_ && parts_ == other.parts_;
    }
    const glm::vec3& gain() const { return options_.gain; }

 private:
    LightOptions options_;    // nothing automatic but the box
    std::vector<Box> parts_;  // of the region: one, or six around a hole
    LightSwarm swarm_{};
    DriftTime time_{};
};

/// Range [m], intensity [cd] and region that `options` stands for when they are automatic.
struct LightScale {
    double radius = 0.0;
    double intensity = 0.0;
    LightRegion region;
};
LightScale automatic_light_scale(const LightOptions& options, const Scene& scene);

}  // namespace kilolux
