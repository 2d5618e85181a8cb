// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/bvh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace kilolux {
namespace {

// A ray prepared for intersection tests: its longest axis becomes z, and a shear maps it to
// (0, 0, 1).
struct PreparedRay {
    glm::dvec3 origin;
    glm::dvec3 inverse;  // 1 / direction
    int x, y, z;         // axes
    double shear_x, shear_y, scale_z;
};

PreparedRay prepare(const Ray& ray) {
    const glm::dvec3 length = glm::abs(ray.direction);
    PreparedRay out{};
    out.origin = ray.origin;
    out.inverse = 1.0 / ray.direction;
    out.z = length.x > length.y ? (length.x > length.z ? 0 : 2) : (length.y > length.z ? 1 : 2);
    out.x = (out.z + 1) % 3;
    out.y = (out.z + 2) % 3;
    if (ray.direction[out.z] < 0.0) std::swap(out.x, out.y);
    out.shear_x = ray.direction[out.x] / ray.direction[out.z];
    out.shear_y = ray.direction[out.y] / ray.direction[out.z];
    out.scale_z = 1.0 / ray.direction[out.z];
    return out;
}

// Three edge functions, all of one sign inside. Two triangles that share an edge compute it from
// the same products, so that a ray on the edge cannot miss both.
std::optional<RayHit> intersect(const PreparedRay& ray, const BvhTriangle& triangle) {
    std::array<glm::dvec3, 3> p;  // sheared: the ray is the z axis
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 v = triangle.corners[i] - ray.origin;
        p[i] = {v[ray.x] - ray.shear_x * v[ray.z], v[ray.y] - ray.shear_y * v[ray.z],
                ray.scale_z * v[ray.z]};
    }
    const double u = p[2].x * p[1].y - p[2].y * p[1].x;
    const double v = p[0].x * p[2].y - p[0].y * p[2].x;
    const double w = p[1].x * p[0].y - p[1].y * p[0].x;
    if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) return std::nullopt;
    const double sum = u + v + w;
    if (sum == 0.0) return std::nullopt;
    RayHit hit;
    hit.weights = {u / sum, v / sum, w / sum};
    hit.t = hit.weights[0] * p[0].z + hit.weights[1] * p[1].z + hit.weights[2] * p[2].z;
    return hit;
}

// The t at which the ray enters the box; infinity if it misses it between t_min and t_max. The far
// end is moved out by the rounding error (Ize 2013, "Robust BVH Ray Traversal").
double entry(const PreparedRay& ray, const Box& box, double t_min, double t_max) {
    constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
    double near = t_min;
    double far = t_max;
    for (int axis = 0; axis < 3; ++axis) {
        double t0 = (box.min[axis] - ray.origin[axis]) * ray.inverse[axis];
        double t1 = (box.max[axis] - ray.origin[axis]) * ray.inverse[axis];
        if (t0 > t1) std::swap(t0, t1);
        t1 *= t1 > 0.0 ? 1.0 + kRounding : 1.0 - kRounding;
        // A ray in the box's face gives 0 * inf = NaN, for which both comparisons are false.
        if (t0 > near) near = t0;
        if (t1 < far) far = t1;
    }
    return near <= far ? near : std::numeric_limits<double>::infinity();
}

// The nearest accepted hit so far; t_max is its t.
struct Nearest {
    std::optional<RayHit> hit;
    double t_max;
};

void test_triangle(const PreparedRay& ray, double t_min, const std::vector<BvhTriangle>& triangles,
                   std::uint32_t index, const std::function<bool(const RayHit&)>& accept,
                   Nearest& best) {
    std::optional<RayHit> hit = intersect(ray, triangles[index]);
    if (!hit || hit->t < t_min || hit->t > best.t_max) return;
    hit->index = index;
    const bool tie = best.hit && hit->t == best.hit->t;
    if (tie && !drawn_before(triangles[index], triangles[best.hit->index])) return;
    if (!accept(*hit)) return;
    best = {hit, hit->t};
}

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

std::optional<RayHit> Bvh::nearest(const Ray& ray,
                                   const std::function<bool(const RayHit&)>& accept) const {
    if (nodes_.empty()) return std::nullopt;
    struct Open {
        std::uint32_t node;
        double entry;
    };
    const PreparedRay prepared = prepare(ray);
    Nearest best{std::nullopt, ray.t_max};
    const auto open_node = [&](std::uint32_t node) -> Open {
        return {node, entry(prepared, nodes_[node].box, ray.t_min, best.t_max)};
    };
    std::vector<Open> stack = {open_node(0)};
    while (!stack.empty()) {
        const Open open = stack.back();
        stack.pop_back();
        if (std::isinf(open.entry) || open.entry > best.t_max) continue;
        const Node& node = nodes_[open.node];
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            test_triangle(prepared, ray.t_min, triangles_, i, accept, best);
        }
        if (node.count > 0) continue;
        const Open left = open_node(node.first), right = open_node(node.first + 1);
        const bool left_first = left.entry <= right.entry;
        stack.push_back(left_first ? right : left);
        stack.push_back(left_first ? left : right);
    }
    return best.hit;
}

std::vector<BvhTriangle> world_triangles(const Scene& scene) {
    std::vector<BvhTriangle> out;
    out.reserve(triangle_count(scene));
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        std::vector<glm::dvec3> world;
        for (const glm::vec3& p : mesh.positions) {
            world.emplace_back(instance.world_from_object * glm::dvec4(glm::dvec3(p), 1.0));
        }
        for (std::size_t k = 0; k + 2 < mesh.indices.size(); k += 3) {
            out.push_back({.corners = {world[mesh.indices[k]], world[mesh.indices[k + 1]],
                                       world[mesh.indices[k + 2]]},
                           .instance = static_cast<std::uint32_t>(i),
                           .triangle = static_cast<std::uint32_t>(k / 3)});
        }
    }
    return out;
}

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

bool drawn_before(const BvhTriangle& a, const BvhTriangle& b) {
    return a.instance != b.instance ? a.instance < b.instance : a.triangle < b.triangle;
}

void merge_on_edges(std::vector<RayHit>& hits, std::span<const BvhTriangle> triangles) {
    constexpr double kSame = 1e-12;
    const auto is_on_edge = [](const RayHit& hit) { return std::ranges::min(hit.weights) < kSame; };
    std::ranges::sort(hits, {}, &RayHit::index);
    for (std::size_t i = hits.size(); i-- > 1;) {
        const auto is_twin = [&](const RayHit& other) {
            return triangles[other.index].instance == triangles[hits[i].index].instance &&
                   std::abs(other.t - hits[i].t) <= kSame * hits[i].t && is_on_edge(other);
        };
        const auto end = hits.begin() + static_cast<std::ptrdiff_t>(i);
        if (is_on_edge(hits[i]) && std::any_of(hits.begin(), end, is_twin)) hits.erase(end);
    }
}

}  // namespace kilolux
