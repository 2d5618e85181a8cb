// SPDX-License-Identifier: Apache-2.0
#include "host/render/lights/light_order.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "host/base/light_cells.h"
#include "host/base/system/parallel.h"
#include "host/scene/lights/light_kinds.h"

namespace kilolux {
namespace {

struct Place {
    int range_exponent = std::numeric_limits<int>::max();
    uint key = 0;
    std::uint32_t light = 0;
};

bool operator<(const Place& a, const Place& b) {
    return std::tie(a.range_exponent, a.key, a.light) < std::tie(b.range_exponent, b.key, b.light);
}

Place place_of(const SceneLight& light, std::uint32_t number) {
    const glm::dvec3& p = light.position;
    const bool placed = kind_of(light).is_placed && std::isfinite(p.x + p.y + p.z) &&
                        std::isfinite(light.range) && light.range > 0.0f;
    if (!placed) return {.light = number};
    const double edge = light_cell_edge(light.range);
    const auto cell = [&](double x) { return light_cell(x, edge); };
    return {std::ilogb(light.range), light_order_key(cell(p.x), cell(p.y), cell(p.z)), number};
}

}  // namespace

std::vector<std::uint32_t> order_by_place(std::span<const SceneLight> lights) {
    std::vector<Place> places(lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        places[i] = place_of(lights[i], static_cast<std::uint32_t>(i));
    }
    parallel_sort(places);
    std::vector<std::uint32_t> order(lights.size());
    std::transform(places.begin(), places.end(), order.begin(),
                   [](const Place& place) { return place.light; });
    return order;
}

}  // namespace kilolux
