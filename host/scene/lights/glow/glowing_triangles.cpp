// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/glow/glowing_triangles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_shape.h"

namespace kilolux {
namespace {

constexpr double kThinnest = 1e-5;   // height of a triangle, relative to its longest edge
constexpr double kRectangle = 1e-5;  // error of a rectangle, relative to its diagonal

// A triangle whose longest edge is the one from corner 0 to 1.
struct GlowingTriangle {
    std::array<glm::dvec3, 3> corners;      // [m], world, counter-clockwise from the front
    std::array<std::uint32_t, 2> end_of{};  // vertices of the longest edge
    MeanEmission emission;
    bool in_rectangle = false;
};
static_assert(sizeof(GlowingTriangle) <= 160);

GlowingTriangle triangle_of(const GlowingInstance& of, std::size_t number, bool mirrored) {
    std::array<std::uint32_t, 3> index{};
    std::array<glm::dvec3, 3> corner{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t from = mirrored ? (3 - i) % 3 : i;  // a mirror turns the winding
        index[i] = of.mesh.indices[3 * number + from];
        corner[i] = glm::dvec3(of.world_from_object *
                               glm::dvec4(glm::dvec3(of.mesh.positions[index[i]]), 1.0));
    }
    std::size_t first = 0;
    double longest = -1.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double length = glm::distance(corner[i], corner[(i + 1) % 3]);
        if (!(length > longest)) continue;
        longest = length;
        first = i;
    }
    GlowingTriangle out;
    for (std::size_t i = 0; i < 3; ++i) out.corners[i] = corner[(first + i) % 3];
    out.end_of = {index[first], index[(first + 1) % 3]};
    out.emission = of.emission.empty() ? MeanEmission{glm::dvec3(of.material.emissive), 0.0}
                                       : of.emission[number];
    return out;
}

// Sets the candela of a shape of this luminance [nit]; whether floats hold size and light.
bool set_luminance(SceneLight& light, const glm::dvec3& luminance) {
    const glm::dvec3 candela = luminance * seen_area(light);
    light.intensity = glm::vec3(candela);
    const glm::vec3& i = light.intensity;
    return size_problem(light).empty() && is_finite(light.position) && is_finite(glm::dvec3(i)) &&
           std::max({i.x, i.y, i.z}) > 0.0f && light.direction != glm::dvec3(0.0);
}

SceneLight surface_light(const GlowingInstance& of) {
    SceneLight light;
    light.of_surface = true;
    light.two_sided = of.material.double_sided;
    return light;
}

std::optional<SceneLight> light_of(const GlowingInstance& of, const GlowingTriangle& t) {
    SceneLight light = surface_light(of);
    set_triangle(light, t.corners[0], t.corners[1], t.corners[2]);
    if (!(double{light.height} > kThinnest * double{light.width})) return std::nullopt;
    if (!set_luminance(light, t.emission.radiance)) return std::nullopt;
    return light;
}

// The rectangle of two triangles that share their longest edge, one in each direction.
std::optional<SceneLight> rectangle_of(const GlowingInstance& of, const GlowingTriangle& a,
                                       const GlowingTriangle& b) {
    if (a.emission != b.emission || a.emission.variance != 0.0) return std::nullopt;
    const glm::dvec3 x = a.corners[0] - a.corners[2], y = a.corners[1] - a.corners[2];
    const double most = kRectangle * glm::distance(a.corners[0], a.corners[1]);
    if (!(std::abs(glm::dot(x, y)) <= most * std::min(glm::length(x), glm::length(y)))) {
        return std::nullopt;
    }
    if (!(glm::distance(b.corners[2], a.corners[2] + x + y) <= most)) return std::nullopt;
    if (!(glm::distance(a.corners[0], b.corners[1]) <= most)) return std::nullopt;
    SceneLight light = surface_light(of);
    set_rectangle(light, a.corners[2], x, y);
    if (!set_luminance(light, a.emission.radiance)) return std::nullopt;
    return light;
}

// The longest edge of a triangle by its ends in object space, whichever comes first.
struct SharedEdge {
    std::array<std::uint32_t, 6> ends{};  // bits of floats
    std::size_t triangle = 0;
    bool operator<(const SharedEdge& other) const {
        return std::pair(ends, triangle) < std::pair(other.ends, other.triangle);
    }
};
static_assert(sizeof(SharedEdge) <= 32);

// 0 has the same bits with either sign.
std::array<std::uint32_t, 3> bits_of(const glm::vec3& p) {
    return {std::bit_cast<std::uint32_t>(p.x + 0.0f), std::bit_cast<std::uint32_t>(p.y + 0.0f),
            std::bit_cast<std::uint32_t>(p.z + 0.0f)};
}

std::vector<SharedEdge> longest_edges(const Mesh& mesh,
                                      const std::vector<GlowingTriangle>& triangles) {
    std::vector<SharedEdge> out;
    out.reserve(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        std::array<std::uint32_t, 3> a = bits_of(mesh.positions[triangles[i].end_of[0]]);
        std::array<std::uint32_t, 3> b = bits_of(mesh.positions[triangles[i].end_of[1]]);
        if (b < a) std::swap(a, b);
        out.push_back({{a[0], a[1], a[2], b[0], b[1], b[2]}, i});
    }
    std::ranges::sort(out, [](const SharedEdge& a, const SharedEdge& b) { return a < b; });
    return out;
}

// The light at the place of the first triangle of each rectangle.
std::vector<std::optional<SceneLight>> merge_rectangles(const GlowingInstance& of,
                                                        std::vector<GlowingTriangle>& triangles) {
    std::vector<std::optional<SceneLight>> out(triangles.size());
    const std::vector<SharedEdge> edges = longest_edges(of.mesh, triangles);
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        if (edges[i].ends != edges[i + 1].ends) continue;
        GlowingTriangle& a = triangles[edges[i].triangle];
        GlowingTriangle& b = triangles[edges[i + 1].triangle];
        if (a.in_rectangle) continue;
        std::optional<SceneLight>& light = out[edges[i].triangle];
        light = rectangle_of(of, a, b);
        a.in_rectangle = b.in_rectangle = light.has_value();
    }
    return out;
}

}  // namespace

TriangleLights make_triangle_lights(const GlowingInstance& of) {
    const bool mirrored = glm::determinant(glm::dmat3(of.world_from_object)) < 0.0;
    std::vector<GlowingTriangle> triangles;
    triangles.reserve(of.mesh.indices.size() / 3);
    for (std::size_t i = 0; 3 * i < of.mesh.indices.size(); ++i) {
        triangles.push_back(triangle_of(of, i, mirrored));
    }
    const auto rectangles = merge_rectangles(of, triangles);
    TriangleLights out;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const GlowingTriangle& t = triangles[i];
        const glm::dvec3& radiance = t.emission.radiance;
        if (radiance == glm::dvec3(0.0)) continue;
        if (t.in_rectangle) {
            ++out.triangles;
            if (!rectangles[i]) continue;
            ++out.rectangles;
            out.lights.push_back(*rectangles[i]);
            continue;
        }
        const std::optional<SceneLight> light = light_of(of, t);
        if (!light) {
            ++out.left_out;
            continue;
        }
        ++out.triangles;
        out.lights.push_back(*light);
        if (t.emission.variance == 0.0) continue;
        ++out.varied;
        out.varied_area += seen_area(*light);
        out.squares += seen_area(*light) * t.emission.variance / glm::dot(radiance, radiance);
    }
    return out;
}

}  // namespace kilolux
