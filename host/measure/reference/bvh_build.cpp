// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "host/measure/reference/bvh.h"

namespace kilolux {
namespace {

constexpr std::size_t kLeafTriangles = 4;
// Deeper nodes are split in half by count, which ends after at most 32 more levels.
constexpr int kHeuristicDepth = 64;

bool usable(const BvhTriangle& triangle) {
    const auto& [a, b, c] = triangle.corners;
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double extent = glm::dot(normal, normal);
    return std::isfinite(extent) && extent > 0.0;
}

// A triangle while the tree is built.
struct Item {
    Box box;
    std::uint32_t triangle = 0;
};

void merge(Box& box, const Box& other) {
    box.add(other.min);
    box.add(other.max);
}

double half_area(const Box& box) {
    const glm::dvec3 s = box.size();
    return s.x * s.y + s.y * s.z + s.z * s.x;
}

void sort_along_longest_axis(std::span<Item> items) {
    Box centers;
    for (const Item& item : items) centers.add(item.box.center());
    const glm::dvec3 s = centers.size();
    const int axis = s.x > s.y ? (s.x > s.z ? 0 : 2) : (s.y > s.z ? 1 : 2);
    std::ranges::sort(items, {}, [axis](const Item& item) { return item.box.center()[axis]; });
}

// How many of the sorted items go to the left: the cost of a side is its number of items times the
// area of their box.
std::size_t cheapest_cut(std::span<const Item> items) {
    std::vector<double> right_cost(items.size());
    Box right, left;
    for (std::size_t i = items.size() - 1; i > 0; --i) {
        merge(right, items[i].box);
        right_cost[i] = half_area(right) * static_cast<double>(items.size() - i);
    }
    std::size_t best = 1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < items.size(); ++i) {
        merge(left, items[i - 1].box);
        const double cost = half_area(left) * static_cast<double>(i) + right_cost[i];
        if (cost >= least) continue;
        best = i;
        least = cost;
    }
    return best;
}

}  // namespace

struct Bvh::Builder {
    std::vector<Item> items;
    std::vector<Node>& nodes;

    // Fills a node that is there with the items first .. first + count, and adds its children.
    void build(std::size_t node, std::size_t first, std::size_t count, int depth) {
        const auto range = std::span(items).subspan(first, count);
        for (const Item& item : range) merge(nodes[node].box, item.box);
        if (count <= kLeafTriangles) {
            nodes[node].first = static_cast<std::uint32_t>(first);
            nodes[node].count = static_cast<std::uint32_t>(count);
            return;
        }
        sort_along_longest_axis(range);
        const std::size_t left = depth < kHeuristicDepth ? cheapest_cut(range) : count / 2;
        const std::size_t child = nodes.size();
        nodes[node].first = static_cast<std::uint32_t>(child);
        nodes.resize(child + 2);
        build(child, first, left, depth + 1);
        build(child + 1, first + left, count - left, depth + 1);
    }
};

Bvh::Bvh(std::vector<BvhTriangle> triangles) {
    std::erase_if(triangles, [](const BvhTriangle& t) { return !usable(t); });
    if (triangles.empty()) return;
    Builder builder{.items = {}, .nodes = nodes_};
    for (const BvhTriangle& triangle : triangles) {
        Item& item = builder.items.emplace_back();
        item.triangle = static_cast<std::uint32_t>(builder.items.size() - 1);
        for (const glm::dvec3& corner : triangle.corners) item.box.add(corner);
    }
    nodes_.resize(1);
    builder.build(0, 0, triangles.size(), 0);
    for (const Item& item : builder.items) triangles_.push_back(triangles[item.triangle]);
}

}  // namespace kilolux
