// SPDX-License-Identifier: Apache-2.0
#include "host/measure/photometry/measuring_points.h"

#include <algorithm>
#include <numeric>

#include "host/base/system/parallel.h"
#include "host/scene/scene.h"

namespace kilolux {
namespace {

void halve_points(std::span<const MeasuringPoint> points, std::span<std::uint32_t> order) {
    const std::size_t groups = (order.size() + kGroupPoints - 1) / kGroupPoints;
    if (groups <= 1) return;
    Box box;
    for (const std::uint32_t i : order) box.add(points[i].position);
    const glm::dvec3 size = box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto middle = static_cast<std::ptrdiff_t>(groups / 2 * kGroupPoints);
    std::nth_element(order.begin(), order.begin() + middle, order.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double x = points[a].position[axis], y = points[b].position[axis];
                         return x < y || (x == y && a < b);
                     });
    const auto split = static_cast<std::size_t>(middle);
    parallel_invoke([&] { halve_points(points, order.first(split)); },
                    [&] { halve_points(points, order.subspan(split)); });
}

}  // namespace

std::vector<std::uint32_t> order_in_groups(std::span<const MeasuringPoint> points) {
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0u);
    halve_points(points, order);
    return order;
}

}  // namespace kilolux
