// SPDX-License-Identifier: Apache-2.0
#include "host/render/lights/generated_lights.h"

#include <tbb/parallel_for.h>

#include <array>
#include <cmath>

namespace kilolux {
namespace {

// Lights are ordered anew this often [s]: they move at most 1.2 m/s, so neighbours stay neighbours.
constexpr double kOrderInterval = 0.5;
// Paths start at a multiple of this [s], so that turns a second err by less than 2^-54 turns.
constexpr double kPathInterval = 1024.0;

double floor_to(double time, double interval) { return std::floor(time / interval) * interval; }

std::array<double, 3> axes(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

bool GeneratedLights::set(const LightOptions& options, const Scene& scene, double time) {
    time_ = time;
    generator_.emplace(options, scene, time);
    const double start = floor_to(time, kPathInterval);
    if (staged_ && start_ == start && staged_->has_paths_of(*generator_)) return false;
    staged_.reset();  // a failure leaves nothing staged
    stage(LightGenerator(options, scene, start), options.count);
    start_ = start;
    return true;
}

void GeneratedLights::stage(const LightGenerator& paths, std::size_t count) {
    order_time_.reset();
    box_ = {};
    std::vector<DriftBox> boxes;
    for (const Box& part : paths.parts()) {
        boxes.push_back(drift_box(axes(part.min), axes(part.size()), paths.range()));
        box_.add(part.min);
        box_.add(part.max);
    }
    const std::span<LightDrift> rows = drift_.stage(count, boxes);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        const LightTrack track = paths.track(i);
        const LightTurns turns = paths.turns(track);
        const glm::vec3& c = track.intensity;
        rows[i] = light_drift(axes(turns.at), axes(turns.rate), {c.x, c.y, c.z}, track.part);
    });
    drift_.upload();
    count_ = count;
    staged_ = paths;
}

void GeneratedLights::place(const DeviceArray<WorldLight>& world, std::size_t first,
                            StageTimer& timer) {
    const double order_time = floor_to(time_, kOrderInterval);
    if (order_time_ != order_time) {
        drift_.order(order_time - start_, timer);
        order_time_ = order_time;
        order_.clear();
    }
    drift_.place(world, first, time_ - start_, timer);
}

void GeneratedLights::read_order() {
    if (order_.empty()) order_ = drift_.download_order();
}

}  // namespace kilolux
