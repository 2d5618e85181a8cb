// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/atrium/plan.h"

#include "host/scene/generated/mesh_builder.h"

namespace kilolux::atrium_plan {
namespace {

// The place `along` a side, 0 in its middle.
Place on_side(int side, double along, int index) {
    const double depth = side % 2 == 0 ? kHalfZ : kHalfX;
    const glm::dmat4 turn = placed(glm::dvec3(0.0), side);
    return {turn * placed({along, 0.0, depth}), side, index};
}

int bay_count(int side) { return side % 2 == 0 ? kLongBays : kShortBays; }

}  // namespace

double half_length(int side) { return side % 2 == 0 ? kHalfX : kHalfZ; }

std::vector<Place> bays() {
    std::vector<Place> out;
    for (int side = 0; side < 4; ++side) {
        for (int i = 0; i < bay_count(side); ++i) {
            out.push_back(on_side(side, (i + 0.5) * kBay - half_length(side), i));
        }
    }
    return out;
}

bool is_even(const Place& bay) { return (bay.index + bay.side) % 2 == 0; }

std::vector<Place> corners() {
    std::vector<Place> out;
    for (int side = 0; side < 4; ++side) out.push_back(on_side(side, half_length(side), side));
    return out;
}

std::vector<Place> sides() {
    std::vector<Place> out;
    for (int side = 0; side < 4; ++side) out.push_back(on_side(side, 0.0, 0));
    return out;
}

}  // namespace kilolux::atrium_plan
