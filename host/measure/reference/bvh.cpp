// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/bvh.h"

#include <cmath>
#include <limits>

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

bool drawn_before(const BvhTriangle& a, const BvhTriangle& b) {
    return a.instance != b.instance ? a.instance < b.instance : a.triangle < b.triangle;
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

}  // namespace kilolux
