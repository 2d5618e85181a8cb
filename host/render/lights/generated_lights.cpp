// SPDX-License-Identifier: Apache-2.0
#include "host/render/lights/generated_lights.h"

#include <cmath>

namespace kilolux {
namespace {

// Lights are ordered anew this often [s]: they move at most 1.2 m/s, so neighbours stay neighbours.
constexpr double kOrderInterval = 0.5;

double floor_to(double time, double interval) {
    if (std::abs(time) >= 0x1p53) return time;  // whole, and a quotient may overflow
    return std::floor(time / interval) * interval;
}

}  // namespace

void GeneratedLights::set(const LightOptions& options, const Scene& scene, double time) {
    const LightGenerator made(options, scene, time);
    if (!generator_ || !generator_->has_paths_of(made)) {
        generator_.reset();  // a failure leaves none
        count_ = 0;
        order_time_.reset();
        order_.clear();
        box_ = {};
        for (const Box& part : made.parts()) {
            box_.add(part.min);
            box_.add(part.max);
        }
        drift_.set(made.swarm(), options.count);
        count_ = options.count;
    } else if (generator_->gain() != made.gain()) {
        drift_.set(made.swarm(), count_);
    }
    time_ = time;
    generator_ = made;
}

void GeneratedLights::place(const DeviceArray<WorldLight>& world, std::size_t first,
                            StageTimer& timer) {
    const double order_time = floor_to(time_, kOrderInterval);
    if (order_time_ != order_time) {
        drift_.order(drift_time(order_time), timer);
        order_time_ = order_time;
        order_.clear();
    }
    drift_.place(world, first, drift_time(time_), timer);
}

void GeneratedLights::read_order() {
    if (order_.empty()) order_ = drift_.download_order();
}

}  // namespace kilolux
