// SPDX-License-Identifier: Apache-2.0
#include "host/render/light_order.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <thread>
#include <tuple>

#include "host/base/light_cells.h"

namespace kilolux {
namespace {

constexpr std::size_t kSerialCount = 1 << 15;  // fewer places are sorted before a thread starts

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
    const bool placed = light.type != LightType::directional && std::isfinite(p.x + p.y + p.z) &&
                        std::isfinite(light.range) && light.range > 0.0f;
    if (!placed) return {.light = number};
    const double edge = light_cell_edge(light.range);
    const auto cell = [&](double x) { return light_cell(x, edge); };
    return {std::ilogb(light.range), light_order_key(cell(p.x), cell(p.y), cell(p.z)), number};
}

// Calls each(0) ... each(parts - 1), in a thread each.
template <typename Each>
void for_each_part(std::size_t parts, const Each& each) {
    std::vector<std::jthread> workers;
    for (std::size_t i = 1; i < parts; ++i) workers.emplace_back(each, i);
    each(0);
}

// Parts by themselves, then neighbours merged, two by two.
void sort_places(std::vector<Place>& places) {
    const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
    const std::size_t wanted = std::clamp(places.size() / kSerialCount, std::size_t{1}, cores);
    std::size_t parts = std::bit_floor(wanted);
    const auto begin_of = [&](std::size_t part) {
        return places.begin() + static_cast<std::ptrdiff_t>(places.size() * part / parts);
    };
    for_each_part(parts, [&](std::size_t i) { std::sort(begin_of(i), begin_of(i + 1)); });
    for (; parts > 1; parts /= 2) {
        for_each_part(parts / 2, [&](std::size_t i) {
            std::inplace_merge(begin_of(2 * i), begin_of(2 * i + 1), begin_of(2 * i + 2));
        });
    }
}

}  // namespace

std::vector<std::uint32_t> order_by_place(std::span<const SceneLight> lights) {
    std::vector<Place> places(lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        places[i] = place_of(lights[i], static_cast<std::uint32_t>(i));
    }
    sort_places(places);
    std::vector<std::uint32_t> order(lights.size());
    std::transform(places.begin(), places.end(), order.begin(),
                   [](const Place& place) { return place.light; });
    return order;
}

void sort_by_place(std::vector<SceneLight>& lights) {
    std::vector<SceneLight> sorted;
    sorted.reserve(lights.size());
    for (const std::uint32_t light : order_by_place(lights)) sorted.push_back(lights[light]);
    lights = std::move(sorted);
}

}  // namespace kilolux
