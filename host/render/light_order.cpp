// SPDX-License-Identifier: Apache-2.0
#include "host/render/light_order.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <thread>
#include <tuple>

namespace kilolux {
namespace {

constexpr int kAxisBits = 21;                  // three axes fill 63 bits
constexpr std::size_t kSerialCount = 1 << 15;  // fewer places are sorted before a thread starts

// The bits of x, two zeros between each.
std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    x = (x | x << 2) & 0x1249249249249249;
    return x;
}

// The number of the cell of this edge, from the middle of the range of numbers on.
std::uint64_t cell_of(double x, double edge) {
    constexpr double kMiddle = 1 << (kAxisBits - 1);
    return static_cast<std::uint64_t>(
        std::clamp(std::floor(x / edge) + kMiddle, 0.0, 2.0 * kMiddle - 1.0));
}

std::uint64_t reversed(std::uint64_t x) {
    x = (x & 0x5555555555555555) << 1 | (x >> 1 & 0x5555555555555555);
    x = (x & 0x3333333333333333) << 2 | (x >> 2 & 0x3333333333333333);
    x = (x & 0x0f0f0f0f0f0f0f0f) << 4 | (x >> 4 & 0x0f0f0f0f0f0f0f0f);
    return __builtin_bswap64(x);
}

// Along the curve within a cube; cubes by the reversed bits of their number, so that neighbours are
// far from each other: lights near the camera cost more than others, and consecutive ones are
// culled by one work-group.
std::uint64_t scatter_cubes(std::uint64_t morton) {
    constexpr int kCubeBits = 3 * 5;  // of the cells in a cube
    const std::uint64_t cell = morton & ((std::uint64_t{1} << kCubeBits) - 1);
    return reversed(morton >> kCubeBits << (kCubeBits + 1)) << kCubeBits | cell;
}

struct Place {
    int range_exponent = std::numeric_limits<int>::max();
    std::uint64_t key = 0;
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
    const int exponent = std::ilogb(light.range);
    const double edge = std::ldexp(0.125, exponent);
    return {exponent,
            scatter_cubes(spread(cell_of(p.x, edge)) | spread(cell_of(p.y, edge)) << 1 |
                          spread(cell_of(p.z, edge)) << 2),
            number};
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
