// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "host/scene/lights/light_generator.h"
#include "host/stages/lights/drift_lights.h"

namespace kilolux {

/// The generated lights of LightOptions, which the device makes, moves and orders. Their places at
/// a time do not depend on earlier times.
class GeneratedLights {
 public:
    GeneratedLights(const Gpu& gpu, const Tuning& tuning) : drift_(gpu, tuning) {}

    /// Takes the lights of `options` in the scene as it is now, at `time` [s].
    void set(const LightOptions& options, const Scene& scene, double time);

    std::size_t count() const { return count_; }

    /// The corners between which all of them stay.
    const Box& box() const { return box_; }

    /// Writes their rows from `first` on, in the order of their places. Enqueues only.
    void place(const DeviceArray<WorldLight>& world, std::size_t first, StageTimer& timer);

    /// Brings their order to the host for at(). Blocks.
    void read_order();

    /// One of the lights, where there are some: all have its range and brightness.
    SceneLight first() const { return (*generator_)[0]; }

    /// The light of row first + `place`: after read_order().
    SceneLight at(std::size_t place) const { return (*generator_)[order_[place]]; }

 private:
    DriftLights drift_;
    std::optional<LightGenerator> generator_;  // at time_
    std::size_t count_ = 0;
    Box box_;
    double time_ = 0.0;                 // [s]
    std::optional<double> order_time_;  // by which the device has ordered them; none: it has not
    std::vector<std::uint32_t> order_;  // on the host, if it was read
};

}  // namespace kilolux
