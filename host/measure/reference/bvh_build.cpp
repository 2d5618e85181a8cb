// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "host/measure/reference/bvh.h"

namespace kilolux {
namespace {

constexpr std::uint32_t kLeafTriangles = 4;
constexpr std::size_t kBins = 16;
// Relative costs of testing a triangle and of visiting a node.
constexpr double kTriangleCost = 1.0;
constexpr double kNodeCost = 1.0;
// Deeper nodes are split in half by count, which ends after at most 32 more levels.
constexpr int kHeuristicDepth = 64;

bool usable(const BvhTriangle& triangle) {
    const auto& [a, b, c] = triangle.corners;
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double extent = glm::dot(normal, normal);
    return std::isfinite(extent) && extent > 0.0;
}

Box box_of(const BvhTriangle& triangle) {
    Box box;
    for (const glm::dvec3& corner : triangle.corners) box.add(corner);
    return box;
}

void merge(Box& box, const Box& other) {
    box.min = glm::min(box.min, other.min);
    box.max = glm::max(box.max, other.max);
}

double half_area(const Box& box) {
    if (box.empty()) return 0.0;
    const glm::dvec3 s = box.size();
    return s.x * s.y + s.y * s.z + s.z * s.x;
}

// A triangle while the tree is built.
struct Item {
    Box box;
    glm::dvec3 center;
    std::uint32_t triangle = 0;
};

struct Bin {
    Box box;
    std::uint32_t count = 0;
};

struct Split {
    int axis = -1;  // -1: none is better than a leaf
    std::size_t bin = 0;
    double cost = 0.0;
};

std::size_t bin_of(const Item& item, const Box& centers, int axis) {
    const double size = centers.max[axis] - centers.min[axis];
    const double share = (item.center[axis] - centers.min[axis]) / size;
    return std::min(kBins - 1, static_cast<std::size_t>(share * static_cast<double>(kBins)));
}

// Cost of a split before each bin: items on each side times the area of their box.
Split best_split_along(std::span<const Item> items, const Box& centers, int axis) {
    std::array<Bin, kBins> bins;
    for (const Item& item : items) {
        Bin& bin = bins[bin_of(item, centers, axis)];
        merge(bin.box, item.box);
        ++bin.count;
    }
    std::array<double, kBins> right_cost{};
    Bin right;
    for (std::size_t b = kBins - 1; b > 0; --b) {
        merge(right.box, bins[b].box);
        right.count += bins[b].count;
        right_cost[b] = half_area(right.box) * right.count;
    }
    Split best{.axis = -1, .bin = 0, .cost = std::numeric_limits<double>::infinity()};
    Bin left;
    for (std::size_t b = 1; b < kBins; ++b) {
        merge(left.box, bins[b - 1].box);
        left.count += bins[b - 1].count;
        if (left.count == 0 || left.count == items.size()) continue;
        const double cost = half_area(left.box) * left.count + right_cost[b];
        if (cost < best.cost) best = {.axis = axis, .bin = b, .cost = cost};
    }
    return best;
}

Split best_split(std::span<const Item> items, const Box& box, const Box& centers) {
    Split best{.axis = -1, .bin = 0, .cost = std::numeric_limits<double>::infinity()};
    for (int axis = 0; axis < 3; ++axis) {
        if (!(centers.max[axis] > centers.min[axis])) continue;
        const Split split = best_split_along(items, centers, axis);
        if (split.axis >= 0 && split.cost < best.cost) best = split;
    }
    const double leaf = half_area(box) * kTriangleCost * static_cast<double>(items.size());
    const double cut = best.cost * kTriangleCost + half_area(box) * kNodeCost;
    if (items.size() <= kLeafTriangles && leaf <= cut) best.axis = -1;
    return best;
}

// Moves the items of the left side to the front and returns their number.
std::size_t partition(std::span<Item> items, const Box& centers, const Split& split) {
    const auto middle = std::partition(items.begin(), items.end(), [&](const Item& item) {
        return bin_of(item, centers, split.axis) < split.bin;
    });
    return static_cast<std::size_t>(middle - items.begin());
}

}  // namespace

struct Bvh::Builder {
    std::vector<Item> items;
    std::vector<Node>& nodes;

    struct Range {
        std::uint32_t node, first, count;
        int depth;
    };

    // Number of items for the left child; 0: a leaf.
    std::size_t cut(std::span<Item> span, Node& node, int depth) {
        Box centers;
        for (const Item& item : span) {
            merge(node.box, item.box);
            centers.add(item.center);
        }
        if (span.size() == 1) return 0;
        if (depth < kHeuristicDepth) {
            const Split split = best_split(span, node.box, centers);
            if (split.axis >= 0) return partition(span, centers, split);
        }
        return span.size() <= kLeafTriangles ? 0 : span.size() / 2;
    }

    void build() {
        nodes.push_back({});
        std::vector<Range> open = {{0, 0, static_cast<std::uint32_t>(items.size()), 0}};
        while (!open.empty()) {
            const Range range = open.back();
            open.pop_back();
            Node node;
            const auto left = static_cast<std::uint32_t>(
                cut(std::span(items).subspan(range.first, range.count), node, range.depth));
            if (left == 0) {
                node.first = range.first;
                node.count = range.count;
            } else {
                node.first = static_cast<std::uint32_t>(nodes.size());
                nodes.resize(nodes.size() + 2);
                open.push_back({node.first, range.first, left, range.depth + 1});
                open.push_back(
                    {node.first + 1, range.first + left, range.count - left, range.depth + 1});
            }
            nodes[range.node] = node;
        }
    }
};

Bvh::Bvh(std::vector<BvhTriangle> triangles) : triangles_(std::move(triangles)) {
    std::erase_if(triangles_, [](const BvhTriangle& t) { return !usable(t); });
    if (triangles_.empty()) return;
    Builder builder{.items = {}, .nodes = nodes_};
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        const Box box = box_of(triangles_[i]);
        builder.items.push_back(
            {.box = box, .center = box.center(), .triangle = static_cast<std::uint32_t>(i)});
    }
    builder.build();
    std::vector<BvhTriangle> sorted;
    sorted.reserve(triangles_.size());
    for (const Item& item : builder.items) sorted.push_back(triangles_[item.triangle]);
    triangles_ = std::move(sorted);
}

}  // namespace kilolux
